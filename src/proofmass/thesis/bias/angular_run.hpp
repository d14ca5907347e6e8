#pragma once

#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"

// The angular model of section 4.4 over one revolution.
namespace proofmass::thesis {

/// Section 4.4 corrected: 4 states from α alone.
struct AngularRun {
  std::vector<double> raw_radps2;
  std::vector<double> filtered_accel, smoothed_accel;  ///< rad/s²
  std::vector<double> filtered_rad, smoothed_rad;      ///< angle since the start
  std::vector<double> filtered_std_rad;
};

/// nullopt without a pair of opposite sensors at a known radius. Errors: those of the model's
/// filter, with the record's name.
[[nodiscard]] Result<std::optional<AngularRun>> angular_run(const FirstTurn& turn);

}  // namespace proofmass::thesis
