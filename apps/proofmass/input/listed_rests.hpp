#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::app {

/// A rest named in a list.
struct ListedRest {
  calibrate::Dwell dwell;
  std::optional<double> angle_rad;  ///< angle of the table
};

/// The rests of --rests FILE. Throws Failure, also if one is outside the recording.
[[nodiscard]] std::vector<ListedRest> listed_rests(const Recording& recording,
                                                   const std::string& list);

}  // namespace proofmass::app
