#pragma once

#include <optional>

#include "proofmass/thesis/bias/angular_run.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// The items of sections 5.5 and 5.6, each in a file of its own.
namespace proofmass::thesis {

/// Figure 5.18.
[[nodiscard]] Item turning_accel_item(const WheelStudy& study,
                                      const std::optional<AngularRun>& run);
/// Figure 5.19.
[[nodiscard]] Item turning_angle_item(const WheelStudy& study,
                                      const std::optional<AngularRun>& run);

}  // namespace proofmass::thesis
