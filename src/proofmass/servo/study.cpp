#include "proofmass/servo/study.hpp"

#include "proofmass/estimate/motor.hpp"
#include "proofmass/servo/loop/run.hpp"

namespace proofmass::servo {
namespace {

estimate::MotorRecord record_of(const Recording& recording) {
  estimate::MotorRecord record;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    record.time_s.push_back(recording.time.at(k));
  record.voltage_v = recording.channels[0].values;
  record.current_a = recording.channels[1].values;
  for (std::size_t c = 2; c + 1 < recording.channels.size(); c += 2)
    record.accel_mps2.push_back(
        {recording.channels[c].values, recording.channels[c + 1].values, {}});
  return record;
}

// Figures that the recording does not determine are as for a drive without that effect.
estimate::DriveModel model_of(const estimate::MotorSolution& found, double inductance_h) {
  const auto value = [&](const char* name, double otherwise) {
    const estimate::MotorParameter* one = found.find(name);
    return one != nullptr && one->value ? one->value->value : otherwise;
  };
  estimate::DriveModel model{.resistance_ohm = value("resistance", 1.0),
                             .inductance_h = inductance_h,
                             .torque_constant_nmpa = value("torque_constant", 1.0),
                             .inertia_kgm2 = value("inertia", 1.0),
                             .viscous_nmspr = value("viscous_friction", 0.0),
                             .coulomb_nm = value("coulomb_friction", 0.0),
                             .stribeck_speed_radps = value("stribeck_speed", 0.1),
                             .backlash_rad = value("backlash", 0.0)};
  model.breakaway_nm = value("breakaway_friction", model.coulomb_nm);
  return model;
}

}  // namespace

std::string_view name_of(Feedback feedback) {
  constexpr std::array<std::string_view, 4> names{"live_estimate", "double_integration", "atan2",
                                                  "encoder"};
  return names[static_cast<std::size_t>(feedback)];
}

Result<ServoStudy> run_servo_study(const ServoOptions& options) {
  const Result<simulate::DriveResult> recorded = simulate::simulate_drive(
      {.seed = options.seed, .rate_hz = options.rate_hz, .drive = options.drive});
  if (!recorded) return recorded.error();
  const auto found = estimate::estimate_motor(record_of(recorded->recording));
  if (!found) return found.error();
  ServoStudy study{.options = options,
                   .model = model_of(*found, options.drive.inductance_h),
                   .runs = {},
                   .speed_traces = {},
                   .position_traces = {}};
  const Controllers controllers = design_controllers(study.model, options);
  for (int s = 0; s < options.seeds; ++s)
    for (const Feedback feedback : feedbacks)
      for (const bool compensated : {false, true}) {
        Traces traces;
        const auto run = run_loop(options, study.model, controllers,
                                    {.feedback = feedback,
                                     .compensated = compensated,
                                     .seed = options.seed + static_cast<std::uint64_t>(s)},
                                    s == 0 ? &traces : nullptr);
        if (!run) return run.error();
        study.runs.push_back(*run);
        if (s > 0) continue;
        study.speed_traces.push_back(std::move(traces.speed));
        study.position_traces.push_back(std::move(traces.position));
      }
  return study;
}

}  // namespace proofmass::servo
