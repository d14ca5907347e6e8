#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"

// Which columns of a table or recording of a turntable hold what.
namespace proofmass::app {

struct TumbleColumns {
  std::optional<std::size_t> angle, std, direction, mount, plane, time, temperature;
  std::vector<std::size_t> outputs;
  std::vector<std::optional<std::size_t>> output_std;  ///< of each output, "x_std"
};

/// By names and units. `angle` overrules the search for the angle; `chosen` names the outputs, if
/// any. Throws Failure where a column that was named is not there or no output is left.
[[nodiscard]] TumbleColumns tumble_columns(const Recording& recording,
                                           const std::string& angle,
                                           const std::vector<std::string>& chosen);

/// The angles in rad; a column without a unit is in degrees.
[[nodiscard]] std::vector<double> angles_rad(const Channel& channel);

}  // namespace proofmass::app
