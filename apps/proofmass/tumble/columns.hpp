#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"

// Roles of the columns of a table or recording from a turntable.
namespace proofmass::app {

struct TumbleColumns {
  std::optional<std::size_t> angle, std, direction, mount, plane, time, temperature;
  std::vector<std::size_t> outputs;
  std::vector<std::optional<std::size_t>> output_std;  ///< "x_std", for each output
};

/// Assigned by names and units. `angle` overrides the search for the angle; `chosen` names the
/// outputs, if any. Throws Failure if a named column does not exist or no output remains.
[[nodiscard]] TumbleColumns tumble_columns(const Recording& recording,
                                           const std::string& angle,
                                           const std::vector<std::string>& chosen);

/// The angles in rad; a column without a unit is taken as degrees.
[[nodiscard]] std::vector<double> angles_rad(const Channel& channel);

}  // namespace proofmass::app
