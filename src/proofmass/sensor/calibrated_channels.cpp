#include "proofmass/sensor/calibrated_channels.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "proofmass/sensor/calibrated_rates.hpp"
#include "proofmass/sensor/calibration.hpp"

namespace proofmass::sensor {
namespace {

// A recording's only acceleration, whose name ends in no axis: that of a one-axis sensor, called x.
// A magnitude is along no axis.
std::optional<Triad> lone_accelerometer(const Recording& recording) {
  std::optional<Triad> lone;
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    if (recording.channels[k].unit.quantity != Quantity::acceleration) continue;
    std::string name = recording.channels[k].name;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* word : {"absolute", "magnitude", "norm", "total"})
      if (lone || name.find(word) != std::string::npos) return std::nullopt;
    lone = Triad{recording.channels[k].name, k, {}, {}};
  }
  return lone;
}

void bring_to_si(Channel& channel, const char* symbol) {
  for (double& value : channel.values.edit()) value = channel.unit.si(value);
  channel.unit = *parse_unit(symbol);
}

Status bring_to_si(const Triad& triad, Recording& recording) {
  for (const auto& axis : {triad.x, triad.y, triad.z}) {
    if (!axis) continue;
    Channel& channel = recording.channels[*axis];
    if (channel.unit.quantity != Quantity::acceleration)
      return Error{
          Errc::invalid_argument,
          fmt::format("{}: channel {}: expected an acceleration, but it is in {}", recording.source,
                      channel.name,
                      channel.unit.symbol.empty() ? "no known unit" : channel.unit.symbol)};
    bring_to_si(channel, "m/s^2");
  }
  return Done{};
}

}  // namespace

Result<std::vector<Accelerometer>> accelerometers(const std::vector<Recording>& recordings) {
  std::vector<Accelerometer> found;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    std::vector<Triad> triads = accelerometer_triads(recordings[k]);
    if (triads.empty())
      if (auto lone = lone_accelerometer(recordings[k])) triads.push_back(std::move(*lone));
    const std::string& file = recordings[k].source;
    if (triads.empty())
      return Error{Errc::invalid_argument, file + ": no accelerometer channel found"};
    for (const Triad& triad : triads)
      found.push_back({k, triad, triads.size() > 1 ? file + ": " + triad.name : file});
  }
  return found;
}

Status apply(const std::vector<SensorModel>& models,
             const std::vector<Accelerometer>& found,
             std::vector<Recording>& recordings) {
  if (models.size() > 1 && models.size() != found.size())
    return Error{Errc::invalid_argument,
                 fmt::format("{} sensor files for {} accelerometers: expected one for all or one "
                             "for each",
                             models.size(), found.size())};
  for (std::size_t k = 0; k < found.size(); ++k) {
    Recording& recording = recordings[found[k].recording];
    if (!models.empty()) {
      const Status applied = apply(models[models.size() > 1 ? k : 0], found[k].triad, recording);
      if (!applied) return applied.error().at(found[k].name);
    }
    if (Status done = bring_to_si(found[k].triad, recording); !done) return done;
  }
  return Done{};
}

Result<CalibratedBlocks> CalibratedBlocks::make(const Recording& head,
                                                std::vector<std::size_t> channels,
                                                std::vector<SensorModel> models) {
  CalibratedBlocks out;
  out.models_ = std::move(models);
  out.channels_ = std::move(channels);
  Recording& piece = out.pieces_.emplace_back();
  piece.source = head.source;
  piece.time = head.time;
  for (const std::size_t c : out.channels_) {
    Channel& channel = piece.channels.emplace_back(head.channels[c]);
    channel.values.edit().clear();
    out.units_.push_back(channel.unit);
  }
  auto found = sensor::accelerometers(out.pieces_);
  if (!found) return found.error();
  out.found_ = std::move(found).value();
  if (Status done = out.to_si(); !done) return done.error();
  out.head_ = out.pieces_.front();
  return out;
}

const SensorModel* CalibratedBlocks::model_of(std::size_t accelerometer) const {
  if (models_.empty()) return nullptr;
  return &models_[models_.size() > 1 ? accelerometer : 0];
}

Status CalibratedBlocks::add_gyroscope(std::size_t at,
                                       const std::array<std::size_t, 3>& channels,
                                       const Unit& unit_if_unknown) {
  const SensorModel* model = model_of(at);
  const bool calibrated = model != nullptr && is_calibrated(model->gyroscope);
  const bool raw = calibrated && reading_unit(model->gyroscope) != "rad/s";
  Recording& piece = pieces_.front();
  for (const std::size_t c : channels) {
    const bool is_rate = units_[c].quantity == Quantity::angular_rate;
    if (raw && is_rate)
      return Error{
          Errc::invalid_argument,
          fmt::format("the sensor file calibrates the gyroscope's {}, and channel {} is "
                      "in {}",
                      reading_unit(model->gyroscope), piece.channels[c].name, units_[c].symbol)};
    if (!raw && !is_rate) units_[c] = unit_if_unknown;
    head_.channels[c].unit = *parse_unit("rad/s");
  }
  if (!calibrated) return Done{};
  calibrated_gyroscopes_.push_back({at, channels});
  return calibrate(calibrated_gyroscopes_.back());
}

Status CalibratedBlocks::to_si() {
  if (Status done = sensor::apply(models_, found_, pieces_); !done) return done;
  for (Channel& channel : pieces_.front().channels)
    if (channel.unit.quantity == Quantity::angular_rate) bring_to_si(channel, "rad/s");
  for (const Gyroscope& gyroscope : calibrated_gyroscopes_)
    if (Status done = calibrate(gyroscope); !done) return done;
  return Done{};
}

/// The values change hands instead of being copied.
Status CalibratedBlocks::calibrate(const Gyroscope& gyroscope) {
  std::vector<Channel>& channels = pieces_.front().channels;
  const Triad& triad = found_[gyroscope.accelerometer].triad;
  const std::array axes{triad.x, triad.y, triad.z};
  std::array<std::vector<double>, 3> accel_mps2, rates;
  const auto exchange = [&] {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axes[axis]) channels[*axes[axis]].values.edit().swap(accel_mps2[axis]);
      channels[gyroscope.channels[axis]].values.edit().swap(rates[axis]);
    }
  };
  exchange();
  Status done = sensor::apply(model_of(gyroscope.accelerometer)->gyroscope, accel_mps2, rates);
  exchange();
  return done;
}

Result<Block> CalibratedBlocks::apply(const Block& raw) {
  Recording& piece = pieces_.front();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const View<double> values = raw.channels[channels_[i]];
    piece.channels[i].unit = units_[i];
    piece.channels[i].values.edit().assign(values.begin(), values.end());
  }
  if (Status done = to_si(); !done) return done.error();
  Block block{raw.first, {}, raw.stamps_s};
  for (const Channel& channel : piece.channels) block.channels.emplace_back(channel.values);
  return block;
}

}  // namespace proofmass::sensor
