#include "input/gyroscope.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/calibrated_rates.hpp"
#include "proofmass/signal/unusable.hpp"

namespace proofmass::app {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

// Words that name the kind of sensor, in the order of the search.
constexpr std::array<std::string_view, 14> kinds{"accelerometer",
                                                 "acceleration",
                                                 "accel",
                                                 "acc",
                                                 "angular velocity",
                                                 "angular rate",
                                                 "angularrate",
                                                 "angularvelocity",
                                                 "gyroscope",
                                                 "gyro",
                                                 "gyr",
                                                 "omega",
                                                 "rate",
                                                 "linear "};

// A name with sensor kind and axis replaced: "imu_gyr_x" is "imu_?_?" with axis x.
struct AxisOf {
  std::string sensor;
  std::size_t axis = 3;  // 3: none
};

// Whether a letter ends a word that names an axis: "x", "gx"; `word` is where that begins.
bool names_axis(const std::string& text, std::size_t i, std::size_t& word) {
  if (text[i] < 'x' || text[i] > 'z') return false;
  if (i + 1 < text.size() && is_letter(text[i + 1])) return false;
  word = i;
  while (word > 0 && is_letter(text[word - 1])) --word;
  const std::string stem = text.substr(word, i - word);
  return stem.empty() || stem == "a" || stem == "g" || stem == "w" || stem == "f";
}

// The last x, y or z that is not part of a longer word, once the kind is removed; also "gx", "wx".
AxisOf axis_of(const std::string& name) {
  std::string text = lower(name);
  for (const std::string_view kind : kinds) {
    const std::size_t at = text.find(kind);
    if (at != std::string::npos) text.replace(at, kind.size(), "?");
  }
  for (std::size_t i = text.size(); i-- > 0;) {
    std::size_t word = i;
    if (!names_axis(text, i, word)) continue;
    const auto axis = static_cast<std::size_t>(text[i] - 'x');
    std::string sensor = text.substr(0, word) + text.substr(i + 1);
    std::erase_if(sensor, [](char c) { return c == '?' || c == '_' || c == ' ' || c == '.'; });
    return {sensor, axis};
  }
  return {};
}

bool may_be_gyroscope(const Channel& channel) {
  if (channel.unit.quantity == Quantity::angular_rate) return true;
  return channel.unit.quantity == Quantity::unknown &&
         lower(channel.name).find("gyr") != std::string::npos;
}

struct Gyroscope {
  std::string sensor;
  std::array<std::optional<std::size_t>, 3> channels{};
  [[nodiscard]] bool whole() const { return channels[0] && channels[1] && channels[2]; }
};

std::vector<Gyroscope> gyroscopes(const Recording& recording) {
  std::vector<Gyroscope> found;
  for (std::size_t k = 0; k < recording.channels.size(); ++k) {
    if (!may_be_gyroscope(recording.channels[k])) continue;
    const AxisOf of = axis_of(recording.channels[k].name);
    if (of.axis > 2) continue;
    auto place = std::ranges::find(found, of.sensor, &Gyroscope::sensor);
    if (place == found.end()) place = found.insert(found.end(), {of.sensor, {}});
    if (!place->channels[of.axis]) place->channels[of.axis] = k;
  }
  std::erase_if(found, [](const Gyroscope& one) { return !one.whole(); });
  return found;
}

}  // namespace

std::optional<GyroscopeChannels> find_gyroscope(const Recording& recording,
                                                const Triad& accelerometer) {
  const std::vector<Gyroscope> found = gyroscopes(recording);
  if (found.empty()) return std::nullopt;
  const auto first = accelerometer.x ? accelerometer.x : accelerometer.y;
  const std::size_t any = first ? *first : accelerometer.z.value_or(0);
  const std::string sensor = axis_of(recording.channels[any].name).sensor;
  const auto own = std::ranges::find(found, sensor, &Gyroscope::sensor);
  if (own == found.end() && found.size() > 1) return std::nullopt;
  const Gyroscope& one = own == found.end() ? found.front() : *own;
  return GyroscopeChannels{*one.channels[0], *one.channels[1], *one.channels[2]};
}

std::array<std::vector<double>, 3> rates_radps(const Recording& recording,
                                               const GyroscopeChannels& channels,
                                               const std::string& unit_if_unknown,
                                               std::vector<Note>& notes) {
  std::array<std::vector<double>, 3> rates;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Channel& channel = recording.channels[channels[axis]];
    const bool known = channel.unit.quantity == Quantity::angular_rate;
    const Unit unit = known ? channel.unit : *parse_unit(unit_if_unknown);
    if (!known && axis == 0)
      notes.push_back(
          {Severity::warning, fmt::format("{} etc. have no unit: {} is assumed; change it with "
                                          "--rate-unit",
                                          channel.name, unit_if_unknown)});
    rates[axis] = channel.values.copy();
    for (double& value : rates[axis]) value = unit.si(value);
  }
  return rates;
}

std::array<std::vector<double>, 3> calibrated_rates_radps(
    const Recording& recording,
    const GyroscopeChannels& channels,
    const sensor::SensorModel* model,
    const std::array<std::vector<double>, 3>& accel_mps2,
    const std::string& unit_if_unknown,
    std::vector<Note>& notes) {
  if (model == nullptr || !sensor::is_calibrated(model->gyroscope))
    return rates_radps(recording, channels, unit_if_unknown, notes);
  const std::string unit = sensor::reading_unit(model->gyroscope);
  std::array<std::vector<double>, 3> rates;
  if (unit == "rad/s") {
    rates = rates_radps(recording, channels, unit_if_unknown, notes);
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Channel& channel = recording.channels[channels[axis]];
      if (channel.unit.quantity == Quantity::angular_rate)
        throw Failure(usage,
                      fmt::format("{}: the sensor file calibrates the gyroscope's {}, and "
                                  "channel {} is in {}",
                                  recording.source, unit, channel.name, channel.unit.symbol));
      rates[axis] = channel.values.copy();
    }
  }
  const Status applied = sensor::apply(model->gyroscope, accel_mps2, rates);
  if (!applied) throw Failure(usage, applied.error().at(recording.source));
  notes.push_back({Severity::info, fmt::format("gyroscope {} etc.: calibrated by the sensor file",
                                               recording.channels[channels[0]].name)});
  return rates;
}

void drop_unusable(const Triad& accelerometer,
                   const std::optional<GyroscopeChannels>& gyroscope,
                   Recording& recording,
                   std::vector<Note>& notes) {
  std::vector<std::size_t> channels;
  for (const auto& axis : {accelerometer.x, accelerometer.y, accelerometer.z})
    if (axis) channels.push_back(*axis);
  const auto keep = [&](const std::vector<Note>& found) {
    notes.insert(notes.end(), found.begin(), found.end());
  };
  std::vector<std::vector<std::size_t>> sensors{channels};
  if (gyroscope) {
    sensors.emplace_back(gyroscope->begin(), gyroscope->end());
    channels.insert(channels.end(), gyroscope->begin(), gyroscope->end());
  }
  keep(signal::drop_stuck(sensors, recording));
  keep(signal::drop_saturated(channels, recording));
}

const sensor::SensorModel* sensor_model_of(const std::vector<sensor::SensorModel>& models,
                                           std::size_t at) {
  if (models.empty()) return nullptr;
  return models.size() == 1 ? &models.front() : &models[std::min(at, models.size() - 1)];
}

}  // namespace proofmass::app
