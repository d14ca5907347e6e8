#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::app {

/// A rest of a recording that a list names.
struct ListedRest {
  calibrate::Dwell dwell;
  std::optional<double> angle_rad;  ///< of the table
};

/// --rests FILE. Throws Failure, also where one is not in the recording.
[[nodiscard]] std::vector<ListedRest> listed_rests(const Recording& recording,
                                                   const std::string& list);

}  // namespace proofmass::app
