#include "calibrate/encoder.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/report/calibrate/encoder_report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/encoder_update.hpp"

namespace proofmass::app {
namespace {

void expect_one_wheel(const CalibrateCommand& command) {
  if (command.files.size() != 1)
    throw Failure(usage, "--encoder: expected one recording of the wheel");
  if (command.gyro || !command.turntable.empty() || !command.validate.empty() || command.means ||
      !command.supplies_v.empty() || !command.type_b.empty() || command.parameters)
    throw Failure(usage, "--encoder calibrates the encoder only: omit the flags for positions");
}

// Factor that makes volts or counts accelerations: gravity is half the largest swing of an axis.
// The fit determines the response anyway; only the priors are in m/s².
double accel_per_unit(const std::vector<std::vector<double>>& axes, double gravity_mps2) {
  double swing = 0.0;
  for (const std::vector<double>& axis : axes)
    swing =
        std::max(swing, quantile(axis, 0.99).value_or(0.0) - quantile(axis, 0.01).value_or(0.0));
  return swing > 0.0 ? 2.0 * gravity_mps2 / swing : 1.0;
}

void add_axes(const Recording& recording,
              const Accelerometer& one,
              double gravity,
              calibrate::EncoderRecording& out) {
  std::vector<std::vector<double>> axes;
  const std::size_t sensor = out.sensor_of.empty() ? 0 : out.sensor_of.back() + 1;
  bool known = true;
  for (const auto& axis : {one.triad.x, one.triad.y, one.triad.z}) {
    if (!axis) continue;
    const Channel& channel = recording.channels[*axis];
    axes.push_back(channel.values.copy());
    out.axis_names.push_back(channel.name);
    out.sensor_of.push_back(sensor);
    known = known && channel.unit.quantity == Quantity::acceleration;
    if (known)
      for (double& value : axes.back()) value = channel.unit.si(value);
  }
  if (!known) {
    const double factor = accel_per_unit(axes, gravity);
    for (std::vector<double>& axis : axes)
      for (double& value : axis) value *= factor;
  }
  std::ranges::move(axes, std::back_inserter(out.axes));
}

void update(const CalibrateCommand& command, const report::EncoderReport& report) {
  sensor::MeasuredEncoder measured{
      .counts_per_turn = command.encoder.counts_per_turn,
      .errors_rad = {},
      .origin = fmt::format("proofmass calibrate {} --encoder, {:.0f} turns",
                            report::file_name(command.files.front()), report.fit.turns)};
  for (std::size_t order = 0; order < 2; ++order) {
    measured.errors_rad[2 * order] = report.fit.harmonics[order].cos_rad;
    measured.errors_rad[2 * order + 1] = report.fit.harmonics[order].sin_rad;
  }
  const Status done = sensor::update_encoder(command.update_sensor, measured);
  if (!done) throw Failure(status_of(done.error(), Stage::writing), done.error());
}

}  // namespace

void run_calibrate_encoder(const CalibrateCommand& command) {
  expect_one_wheel(command);
  report::EncoderReport report;
  report.inputs = command.files;
  InputFlags input = command.input;
  read_encoder_too(command.encoder, input);
  std::vector<Recording> recordings{
      load_rising(command.files.front(), input, progress_bar(command.output))};
  const Recording& recording = recordings.front();
  if (recording.time.source == TimeSource::none)
    throw Failure(usage, command.files.front() +
                             ": no time column and no --rate: give --rate HZ or --time NAME");
  const auto models = load_sensors(command.input, report.notes);
  const std::vector<Accelerometer> found = accelerometers(recordings);
  for (const Accelerometer& one : found)
    drop_unusable(one.triad, std::nullopt, recordings.front(), report.notes);
  calibrate(models, found, recordings);
  report.notes.insert(report.notes.end(), recording.notes.begin(), recording.notes.end());
  EncoderChannel encoder = encoder_of(recording, command.encoder, command.input, report.notes);
  calibrate::EncoderRecording wheel{.name = command.files.front(),
                                    .time_s = {},
                                    .axes = {},
                                    .axis_names = {},
                                    .sensor_of = {},
                                    .encoder = std::move(encoder.fixes),
                                    .step_rad = encoder.step_rad,
                                    .index_slips = std::move(encoder.index_slips),
                                    .has_index = encoder.has_index};
  for (std::size_t k = 0; k < recording.samples(); ++k)
    wheel.time_s.push_back(recording.time.at(k));
  for (const Accelerometer& one : found)
    add_axes(recording, one, gravity_mps2(command.input), wheel);
  report.channel = encoder.name;
  report.options = {.gravity_mps2 = gravity_mps2(command.input),
                    .nonlinearity = 0.01 * command.nonlinearity_percent,
                    .runout_m = command.runout_m};
  if (command.radius_m) report.options.radius_m = *command.radius_m;
  report.fit = need(calibrate::calibrate_encoder(wheel, report.options), Stage::computing);
  report.index_slips = std::move(wheel.index_slips);
  report.notes.insert(report.notes.end(), report.fit.notes.begin(), report.fit.notes.end());
  if (!command.update_sensor.empty()) without_interruption([&] { update(command, report); });
  finish(report::describe(report), [&] { return report::encoder_series(report); }, command.output);
}

}  // namespace proofmass::app
