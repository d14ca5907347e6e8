#pragma once

#include <vector>

#include "proofmass/estimate/drive/fit.hpp"

// Which of the wheels are on the steered axle. Private to the module.
namespace proofmass::estimate::drive {

/// Path with the assignment of wheels to axles that explains the recordings best: the first, all
/// unsteered, unless another one does clearly better, or what is given. Sets the vehicle's geometry
/// in `setting`, and adds notes on what was found.
[[nodiscard]] Fitted fit_best(const std::vector<DriveWheel>& wheels,
                              const DriveOptions& options,
                              const Recorded& recorded,
                              Setting& setting,
                              DriveSolution& solution);

}  // namespace proofmass::estimate::drive
