#include "record/live_estimate.hpp"

#include <fmt/format.h>
#include <utility>

#include "cli/exit_status.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "input/sensor_options.hpp"
#include "proofmass/estimate/live_tilt.hpp"
#include "proofmass/estimate/live_track.hpp"
#include "proofmass/estimate/live_wheel.hpp"
#include "proofmass/sensor/calibrated_rates.hpp"
#include "proofmass/sensor/calibration.hpp"

namespace proofmass::app {
namespace {

using sensor::CalibratedBlocks;
using Made = Result<std::unique_ptr<LiveAnalysis>>;

// An analysis that calibrates its samples first.
class Calibrated final : public LiveAnalysis {
 public:
  Calibrated(CalibratedBlocks samples, std::unique_ptr<LiveAnalysis> analysis)
      : samples_(std::move(samples)), analysis_(std::move(analysis)) {}

  [[nodiscard]] const std::vector<Channel>& columns() const override {
    return analysis_->columns();
  }
  [[nodiscard]] Status add(const Block& samples, Rows& out) override {
    const Result<Block> calibrated = samples_.apply(samples);
    if (!calibrated) return calibrated.error();
    return analysis_->add(*calibrated, out);
  }
  [[nodiscard]] Status finish(Rows& out) override { return analysis_->finish(out); }
  [[nodiscard]] std::vector<Note> take_notes() override { return analysis_->take_notes(); }

 private:
  CalibratedBlocks samples_;
  std::unique_ptr<LiveAnalysis> analysis_;
};

/// The gyroscope of an accelerometer, in rad/s; without channels if it has none, if it is not to be
/// used, or if it is that of an accelerometer before.
Triad gyroscope_of(std::size_t accelerometer,
                   const RecordCommand& command,
                   CalibratedBlocks& samples,
                   std::vector<Note>& notes) {
  const Triad& triad = samples.accelerometers()[accelerometer].triad;
  if (command.no_gyro || triad.axes() < 3) return {};
  const auto channels = find_gyroscope(samples.head(), triad);
  if (!channels) return {};
  for (std::size_t k = 0; k < accelerometer; ++k)
    if (find_gyroscope(samples.head(), samples.accelerometers()[k].triad) == channels) return {};
  const Channel& first = samples.head().channels[(*channels)[0]];
  const sensor::SensorModel* model = sensor_model_of(samples.models(), accelerometer);
  if (model != nullptr && sensor::is_calibrated(model->gyroscope))
    notes.push_back({Severity::info,
                     fmt::format("gyroscope {} etc.: calibrated by the sensor file", first.name)});
  else if (first.unit.quantity != Quantity::angular_rate)
    notes.push_back({Severity::warning,
                     fmt::format("{} etc. have no unit: {} is assumed; change it with --rate-unit",
                                 first.name, command.rate_unit)});
  const Triad found{first.name + " etc.", (*channels)[0], (*channels)[1], (*channels)[2]};
  const Status done =
      samples.add_gyroscope(accelerometer, *channels, *parse_unit(command.rate_unit));
  if (!done) throw Failure(usage, done.error().message);
  return found;
}

Made make_wheel(const RecordCommand& command, CalibratedBlocks& samples, std::vector<Note>& notes) {
  estimate::LiveWheelOptions options;
  for (std::size_t k = 0; k < samples.accelerometers().size(); ++k) {
    options.sensors.push_back(samples.accelerometers()[k].triad);
    options.gyroscopes.push_back(gyroscope_of(k, command, samples, notes));
  }
  options.rate_hz = samples.head().time.rate_hz;
  if (command.lag_s) options.lag_s = *command.lag_s;
  options.wheel.gravity_mps2 = gravity_mps2(command.input);
  options.wheel.radius_m = command.radius_m;
  options.wheel.rolling_radius_m = command.rolling_radius_m;
  options.wheel.bandwidth_hz = command.bandwidth_hz;
  if (!command.axis.empty()) options.wheel.spin_axis = parse_axis(command.axis);
  if (!samples.models().empty()) {
    const sensor::SensorModel& model = samples.models().front();
    options.wheel.alignment_std_rad = sensor::alignment_std_rad(model).value_or(0.0);
    if (const auto& bandwidth = model.electrical.bandwidth[0]; bandwidth && !command.bandwidth_hz)
      options.wheel.bandwidth_hz = bandwidth->value;
  }
  return estimate::live_wheel(options);
}

// The single accelerometer that all estimates except the wheel's need.
const Triad& only_accelerometer(const CalibratedBlocks& samples) {
  const auto& found = samples.accelerometers();
  if (found.size() == 1) return found.front().triad;
  std::string names;
  for (const Accelerometer& one : found) names += (names.empty() ? "" : ", ") + one.triad.name;
  throw Failure(usage, "several accelerometers (" + names + "): choose one with --channel");
}

Made make_tilt(const RecordCommand& command, CalibratedBlocks& samples, std::vector<Note>& notes) {
  estimate::LiveTiltOptions options;
  options.accelerometer = only_accelerometer(samples);
  if (const Triad gyroscope = gyroscope_of(0, command, samples, notes); gyroscope.x)
    options.gyroscope = gyroscope;
  options.rate_hz = samples.head().time.rate_hz;
  if (command.lag_s) options.lag_s = *command.lag_s;
  options.tilt.gravity_mps2 = uncertain_gravity_mps2(command.input, std::nullopt, notes);
  if (!samples.models().empty()) options.tilt.calibration = samples.models().front().calibration;
  return estimate::live_tilt(options);
}

Made make_track(const RecordCommand& command, const CalibratedBlocks& samples) {
  estimate::LiveTrackOptions options;
  options.sensor = only_accelerometer(samples);
  if (!command.axis.empty()) options.axis = parse_axis(command.axis);
  options.rate_hz = samples.head().time.rate_hz;
  if (command.lag_s) options.lag_s = *command.lag_s;
  if (!samples.models().empty()) {
    const sensor::SensorModel& model = samples.models().front();
    options.figures = figures_of(model, false);
    options.scale_std = scale_std_of(model.calibration).value_or(options.scale_std);
  }
  return estimate::live_track(options);
}

Made make_analysis(const RecordCommand& command,
                   CalibratedBlocks& samples,
                   std::vector<Note>& notes) {
  if (command.estimate == "tilt") return make_tilt(command, samples, notes);
  if (command.estimate == "track") return make_track(command, samples);
  return make_wheel(command, samples, notes);
}

}  // namespace

acquire::MakeAnalysis make_estimate(const RecordCommand& command,
                                    std::function<void(const std::vector<Channel>&)> columns,
                                    std::vector<Note>& notes) {
  if (command.estimate.empty()) return {};
  return [&, columns = std::move(columns)](const acquire::SourceHead& head) -> Made {
    try {
      CalibratedBlocks samples = calibrated_blocks(command.input, head.recording, notes);
      auto analysis = make_analysis(command, samples, notes);
      if (!analysis) return analysis;
      columns((*analysis)->columns());
      return std::unique_ptr<LiveAnalysis>(
          std::make_unique<Calibrated>(std::move(samples), std::move(analysis).value()));
    } catch (const Failure& failure) {
      return Error{Errc::invalid_argument, failure.what()};
    }
  };
}

}  // namespace proofmass::app
