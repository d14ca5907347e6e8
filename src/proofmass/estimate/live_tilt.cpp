#include "proofmass/estimate/live_tilt.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/live_columns.hpp"
#include "proofmass/estimate/tilt/bias_change.hpp"
#include "proofmass/estimate/tilt/live_filter.hpp"
#include "proofmass/estimate/tilt/record.hpp"
#include "proofmass/estimate/tilt/rest.hpp"
#include "proofmass/estimate/tilt/still.hpp"
#include "proofmass/estimate/wheel/live_epochs.hpp"

namespace proofmass::estimate {
namespace {

constexpr std::size_t fewest_epochs = 10;

std::vector<Channel> tilt_columns() {
  std::vector<Channel> columns;
  for (const char* name : {"roll", "roll_std", "pitch", "pitch_std"})
    columns.push_back(angle_column(name));
  columns.push_back(time_column("smoothed_time"));
  for (const char* name :
       {"smoothed_roll", "smoothed_roll_std", "smoothed_pitch", "smoothed_pitch_std"})
    columns.push_back(angle_column(name));
  columns.push_back(number_column("nis"));
  return columns;
}

bool is_whole(const Triad& triad) {
  return triad.axes() == 3;
}

std::vector<LiveVector> vectors_of(const LiveTiltOptions& options) {
  std::vector<LiveVector> vectors{{options.accelerometer}};
  if (options.gyroscope) vectors.push_back({*options.gyroscope, true});
  return vectors;
}

// No rest is known in advance whose norm would show the biases of an uncalibrated sensor.
LiveTiltOptions with_biases(LiveTiltOptions options, std::vector<Note>& notes) {
  TiltOptions& tilt = options.tilt;
  if (tilt.calibration || tilt.bias_std_mps2) return options;
  tilt.bias_std_mps2 = uncalibrated_bias_std_mps2({}, ForceSpread(tilt), tilt.gravity_mps2);
  notes.push_back(uncalibrated_note(std::nullopt, *tilt.bias_std_mps2, tilt.gravity_mps2.value));
  notes.back().advice = {Advice{"sensor"}};  // a live estimate has no bias_std
  return options;
}

class LiveTilt final : public LiveAnalysis {
 public:
  explicit LiveTilt(const LiveTiltOptions& options)
      : options_(with_biases(options, notes_)),
        spread_(options_.tilt),
        epochs_(vectors_of(options), {options.rate_hz, options.most_rate_hz}) {}

  [[nodiscard]] const std::vector<Channel>& columns() const override { return columns_; }

  [[nodiscard]] Status add(const Block& samples, Rows& out) override {
    out.channels.resize(columns_.size());
    return epochs_.add(samples, [&](const LiveEpoch& epoch) { take(epoch, out); });
  }

  [[nodiscard]] Status finish(Rows& out) override {
    out.channels.resize(columns_.size());
    epochs_.finish([&](const LiveEpoch& epoch) { take(epoch, out); });
    if (!bank_ && first_.size() >= fewest_epochs) start(out);
    return Done{};
  }

  [[nodiscard]] std::vector<Note> take_notes() override {
    for (Note& note : epochs_.take_notes()) notes_.push_back(std::move(note));
    return std::exchange(notes_, {});
  }

 private:
  void take(const LiveEpoch& epoch, Rows& out) {
    if (epoch.anew) {
      bank_.reset();
      first_.clear();
    }
    if (bank_) {
      bank_->step(epoch);
      return give(epoch.time_s, out);
    }
    first_.push_back(epoch);
    if (first_.size() >= fewest_epochs && epoch.time_s - first_.front().time_s >= options_.start_s)
      start(out);
  }

  void start(Rows& out) {
    bank_.emplace(first_, options_);
    judge_force();
    for (const LiveEpoch& epoch : first_) {
      bank_->step(epoch);
      give(epoch.time_s, out);
    }
    first_ = {};
  }

  /// Reports a force that is impossible for a body under gravity.
  void judge_force() {
    std::vector<double> norms;
    for (const LiveEpoch& epoch : first_)
      if (epoch.has(0)) norms.push_back(epoch.vectors[0].norm());
    const double usual = median(norms).value_or(0.0), g = options_.tilt.gravity_mps2.value;
    if (usual > 0.5 * g && usual < 2.0 * g) return;
    notes_.push_back({Severity::bad, options_.accelerometer.name + ": the force has a median of " +
                                         decimal(usual) + " m/s² where gravity is " + decimal(g) +
                                         ": its unit is another, or gravity was removed; "
                                         "the angles are meaningless"});
  }

  void give(double time_s, Rows& out) {
    out.stamps_s.push_back(time_s);
    const LiveTiltFilter& filter = bank_->best();
    const auto now = angles(&filter.now()), then = angles(filter.lagged());
    const double then_s = filter.lagged() == nullptr ? std::numeric_limits<double>::quiet_NaN()
                                                     : filter.lagged_time_s();
    const std::array values{now[0],  now[1],  now[2],  now[3],  then_s,
                            then[0], then[1], then[2], then[3], filter.nis()};
    for (std::size_t i = 0; i < values.size(); ++i) out.channels[i].push_back(values[i]);
  }

  /// Roll and pitch, each with its standard deviation.
  [[nodiscard]] std::array<double, 4> angles(const Gaussian<3>* force) const {
    std::array<double, 4> out;
    out.fill(std::numeric_limits<double>::quiet_NaN());
    if (force == nullptr) return out;
    const TiltAngles found = spread_.angles(force->mean, force->cov);
    if (found.roll_rad)
      std::tie(out[0], out[1]) = std::tie(found.roll_rad->value, found.roll_rad->std);
    if (found.pitch_rad)
      std::tie(out[2], out[3]) = std::tie(found.pitch_rad->value, found.pitch_rad->std);
    return out;
  }

  std::vector<Note> notes_;
  LiveTiltOptions options_;
  ForceSpread spread_;
  LiveEpochs epochs_;
  std::vector<Channel> columns_ = tilt_columns();
  std::vector<LiveEpoch> first_;
  std::optional<LiveTiltBank> bank_;
};

}  // namespace

Result<std::unique_ptr<LiveAnalysis>> live_tilt(const LiveTiltOptions& options) {
  if (!is_whole(options.accelerometer) || (options.gyroscope && !is_whole(*options.gyroscope)))
    return Error{Errc::invalid_argument,
                 "live tilt needs three axes of the accelerometer, and of the gyroscope if there "
                 "is one"};
  if (auto status =
          check_live_times({options.rate_hz, options.start_s, options.lag_s, options.most_rate_hz});
      !status)
    return status.error();
  if (!(options.tilt.gravity_mps2.value > 0.0))
    return Error{Errc::invalid_argument, "gravity must be positive"};
  return std::unique_ptr<LiveAnalysis>(std::make_unique<LiveTilt>(options));
}

}  // namespace proofmass::estimate
