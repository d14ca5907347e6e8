#include "proofmass/thesis/wheel/study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/thesis/wheel/rig.hpp"

namespace proofmass::thesis {
namespace {

constexpr double thesis_speed_radps = 11.0 * radps_per_rpm;

/// A quarter more than a turn, so that the speed can be determined over a full one after the ramp.
constexpr double turns = 1.25;

Result<RunErrors> errors_of(const RigRun& run) {
  const Result<WheelRecord> record = simulate_wheel(run);
  if (!record) return record.error();
  const bool shown = std::abs(run.speed_radps - thesis_speed_radps) < 1e-9 && !run.datasheet_errors;
  return run_errors(first_turn(run, *record), shown ? Detail::all : Detail::tangential);
}

/// The seeds' runs at one speed; half of the parts have the datasheet's errors.
Status run_seeds(const WheelRunsOptions& options,
                 const Progress& report_progress,
                 SpeedStudy& speed) {
  for (std::size_t k = 0; k < 2 * options.seeds; ++k) {
    const bool datasheet = k % 2 == 1;
    const auto errors = errors_of({.seed = options.seed + k / 2,
                                   .speed_radps = speed.speed_radps,
                                   .turns = turns,
                                   .datasheet_errors = datasheet,
                                   .gravity_mps2 = options.gravity_mps2});
    if (!errors) return errors.error();
    (datasheet ? speed.datasheet : speed.runs).push_back(*errors);
    if (report_progress)
      report_progress("turning the wheel",
                      static_cast<double>(k) / (2.0 * static_cast<double>(options.seeds)));
  }
  return Done{};
}

/// Table A.1 alone has 8 rpm.
bool is_studied(double rpm) {
  return std::ranges::find(study_speeds_rpm, rpm) != study_speeds_rpm.end();
}

Status simulate_speed(double rpm,
                      const WheelRunsOptions& options,
                      const Progress& report_progress,
                      SpeedStudy& speed) {
  speed.speed_radps = rpm * radps_per_rpm;
  const Result<WheelRecord> record = simulate_wheel({.seed = options.seed,
                                                     .speed_radps = speed.speed_radps,
                                                     .turns = turns,
                                                     .gravity_mps2 = options.gravity_mps2});
  if (!record) return record.error();
  Result<FirstTurn> turn = first_turn(*record, options.gravity_mps2);
  if (!turn) return turn.error();
  speed.turn = std::move(turn).value();
  return is_studied(rpm) ? run_seeds(options, report_progress, speed) : Status(Done{});
}

Status study_record(const WheelRecord& record, double gravity_mps2, SpeedStudy& speed) {
  Result<FirstTurn> turn = first_turn(record, gravity_mps2);
  if (!turn) return turn.error();
  const auto errors = run_errors(*turn, Detail::all);
  if (!errors) return errors.error();
  speed.turn = std::move(turn).value();
  speed.speed_radps = speed.turn.set_speed_radps > 0.0 ? speed.turn.set_speed_radps
                                                       : speed.turn.mean_speed_radps.value;
  speed.runs.push_back(*errors);
  return Done{};
}

}  // namespace

Result<WheelStudy> study_wheel(const std::vector<WheelRecord>& records,
                               const WheelRunsOptions& options) {
  if (records.empty() && options.seeds == 0)
    return Error{Errc::invalid_argument, "the simulated wheel takes at least one run"};
  WheelStudy study{.simulated = records.empty(), .seeds = records.empty() ? options.seeds : 1};
  const std::size_t parts = records.empty() ? setting_speeds_rpm.size() : records.size();
  study.speeds.resize(parts);
  std::vector<Status> done(parts, Done{});
  in_parallel(parts, options.progress, [&](std::size_t k, const Progress& report_progress) {
    SpeedStudy& speed = study.speeds[k];
    done[k] = records.empty()
                  ? simulate_speed(setting_speeds_rpm[k], options, report_progress, speed)
                  : study_record(records[k], options.gravity_mps2, speed);
  });
  for (const Status& status : done)
    if (!status) return status.error();
  std::ranges::stable_sort(study.speeds, {}, &SpeedStudy::speed_radps);
  const auto from_11rpm = [](const SpeedStudy& speed) {
    return std::abs(speed.speed_radps - thesis_speed_radps);
  };
  const auto nearest = std::ranges::min_element(study.speeds, {}, from_11rpm);
  study.shown = static_cast<std::size_t>(nearest - study.speeds.begin());
  const auto fused = fourteen_state_filter(study.at_11rpm().turn);
  if (!fused) return fused.error();
  study.fourteen_state_filter = *fused;
  return study;
}

}  // namespace proofmass::thesis
