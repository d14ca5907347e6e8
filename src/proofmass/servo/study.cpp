#include "proofmass/servo/study.hpp"

#include <algorithm>

#include "proofmass/estimate/motor.hpp"
#include "proofmass/servo/loop/run.hpp"

namespace proofmass::servo {
namespace {

estimate::MotorRecord record_of(const Recording& recording) {
  estimate::MotorRecord record;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    record.time_s.push_back(recording.time.at(k));
  record.voltage_v = recording.channels[0].values.copy();
  record.current_a = recording.channels[1].values.copy();
  for (std::size_t c = 2; c + 1 < recording.channels.size(); c += 2)
    record.accel_mps2.push_back(
        {recording.channels[c].values.copy(), recording.channels[c + 1].values.copy(), {}});
  return record;
}

std::vector<ServoRun> worst_of(const std::vector<ServoRun>& runs) {
  std::vector<ServoRun> out;
  for (const ServoRun& run : runs) {
    const auto found = std::ranges::find_if(out, [&](const ServoRun& one) {
      return one.feedback == run.feedback && one.compensated == run.compensated;
    });
    if (found == out.end()) {
      out.push_back(run);
      continue;
    }
    found->speed_settling_s = longer(found->speed_settling_s, run.speed_settling_s);
    found->position_settling_s = longer(found->position_settling_s, run.position_settling_s);
    for (double ServoRun::* figure : {&ServoRun::speed_ripple_radps, &ServoRun::speed_error_radps,
                                      &ServoRun::position_error_rad, &ServoRun::limit_cycle_rad})
      *found.*figure = std::max(*found.*figure, run.*figure);
  }
  return out;
}

/// The identified model of a simulated drive.
Result<MotorModel> identify(const ServoOptions& options) {
  const Result<simulate::MotorResult> recorded = simulate::simulate_motor(
      {.seed = options.seed, .rate_hz = options.rate_hz, .drive = options.drive});
  if (!recorded) return recorded.error();
  const auto found = estimate::estimate_motor(record_of(recorded->recording));
  if (!found) return found.error();
  return model_of(*found, options.drive.inductance_h);
}

/// Appends the closed loops of one seed, with and without compensation of friction; of the first
/// seed also the traces.
Status add_loops(const Controllers& controllers, int seed, ServoStudy& study) {
  for (const Feedback feedback : feedbacks)
    for (const bool compensated : {false, true}) {
      Traces traces;
      const auto run = run_loop(study.options, study.model, controllers,
                                {.feedback = feedback,
                                 .compensated = compensated,
                                 .seed = study.options.seed + static_cast<std::uint64_t>(seed)},
                                seed == 0 ? &traces : nullptr);
      if (!run) return run.error();
      study.runs.push_back(*run);
      if (seed > 0) continue;
      study.speed_traces.push_back(std::move(traces.speed));
      study.position_traces.push_back(std::move(traces.position));
    }
  return Done{};
}

}  // namespace

std::string_view name_of(Feedback feedback) {
  constexpr std::array<std::string_view, 4> names{"live_estimate", "double_integration", "atan2",
                                                  "encoder"};
  return names[static_cast<std::size_t>(feedback)];
}

Result<ServoStudy> study_servo(const ServoOptions& options) {
  if (!(options.rate_hz >= 50.0 && options.rate_hz <= 5000.0))
    return Error{Errc::invalid_argument, "rate: expected 50 to 5000 Hz"};
  if (options.delay_samples < 1 || options.delay_samples > 20 || options.seeds < 1)
    return Error{Errc::invalid_argument,
                 "expected a delay of 1 to 20 samples and at least one run"};
  const Result<MotorModel> model = identify(options);
  if (!model) return model.error();
  ServoStudy study{.options = options,
                   .model = *model,
                   .runs = {},
                   .worst = {},
                   .speed_traces = {},
                   .position_traces = {}};
  const Controllers controllers = design_controllers(study.model, options);
  for (int s = 0; s < options.seeds; ++s) {
    if (options.progress) options.progress("closed loops", static_cast<double>(s) / options.seeds);
    if (const Status added = add_loops(controllers, s, study); !added) return added.error();
  }
  study.worst = worst_of(study.runs);
  return study;
}

}  // namespace proofmass::servo
