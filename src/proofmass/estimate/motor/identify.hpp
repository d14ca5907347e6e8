#pragma once

#include <optional>

#include "proofmass/estimate/motor.hpp"
#include "proofmass/estimate/motor/electrical.hpp"
#include "proofmass/estimate/motor/mechanical.hpp"

namespace proofmass::estimate::motor {

struct Identified {
  Series series;
  Motion motion;
  std::optional<ElectricalFit> electrical;  ///< nullopt without a current
  MechanicalFit mechanical;
};

/// Both regressions of a record: the electrical one, and the motion that follows from it, in a few
/// rounds, then the mechanical one. `start`: a similar record's, to save time. Errors: as
/// estimate_motor().
[[nodiscard]] Result<Identified> identify(const MotorRecord& record,
                                          const MotorOptions& options,
                                          ElectricalStart start = {});

/// Samples of a motion on a certain flank.
[[nodiscard]] std::size_t moving_samples(const Motion& motion);

}  // namespace proofmass::estimate::motor
