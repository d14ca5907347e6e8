#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/drive/fit.hpp"

// From a fitted path to what is reported of it. Private to the module.
namespace proofmass::estimate::drive {

/// What determines the scale and the heading of a path.
struct Known {
  bool scale = false;  ///< a circumference, or fixes
  bool track = false;  ///< given, or fixes or gyroscopes determine it
  bool yaw = false;    ///< a gyroscope
  bool both_sides = false;
  std::string reference_point;
};

/// Distance, heading, end and constants as far as they are determined, and the reasons in words
/// where they are not.
void report_findings(const Recorded& recorded,
                     const Fitted& fitted,
                     const Known& known,
                     DriveSolution& solution);

}  // namespace proofmass::estimate::drive
