#pragma once

#include "proofmass/servo/loop/gains.hpp"
#include "proofmass/servo/study.hpp"

namespace proofmass::servo {

/// The controllers, designed from the identified model.
struct Controllers {
  Gains speed, position;
};
[[nodiscard]] Controllers design_controllers(const estimate::DriveModel& model, const ServoOptions& options);

struct Traces {
  ServoTrace speed, position;
};

/// The speed steps and the position steps with one kind of feedback.
[[nodiscard]] Result<ServoRun> run_loop(const ServoOptions& options,
                                   const estimate::DriveModel& model,
                                   const Controllers& controllers,
                                   const ServoRun& kind,
                                   Traces* traces);

}  // namespace proofmass::servo
