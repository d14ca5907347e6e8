#pragma once

#include "proofmass/servo/loop/gains.hpp"
#include "proofmass/servo/study.hpp"

namespace proofmass::servo {

/// The controllers, designed from the identified model.
struct Controllers {
  Gains speed, position;
};
[[nodiscard]] Controllers design_controllers(const MotorModel& model, const ServoOptions& options);

/// The longer of two times; nullopt if one is.
[[nodiscard]] std::optional<double> longer(const std::optional<double>& a,
                                           const std::optional<double>& b);

struct Traces {
  ServoTrace speed, position;
};

/// The speed steps and the position steps with one kind of feedback.
[[nodiscard]] Result<ServoRun> run_loop(const ServoOptions& options,
                                        const MotorModel& model,
                                        const Controllers& controllers,
                                        const ServoRun& kind,
                                        Traces* traces);

}  // namespace proofmass::servo
