#pragma once

#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::estimate {

/// What of an accelerometer makes a position found by double integration drift away.
struct BudgetSensor {
  std::string name;
  Uncertain bias_mps2;                 ///< left after calibration
  double white_noise_mps2_rthz = 0.0;  ///< velocity random walk N: the two-sided density
};

struct BudgetError {
  double t_s = 0.0;
  Uncertain position_m;  ///< value from the bias; std from the bias's and from the noise
};

struct BudgetRow {
  std::string name;
  Uncertain bias_mps2;
  std::vector<BudgetError> errors;  ///< one for each time
};

/// Error of the position that double integration from rest gives after each time,
///
///     ½ b t² ± √((½ σ_b t²)² + N² t³/3).
///
/// Source: D. H. Titterton, J. L. Weston, Strapdown Inertial Navigation Technology, 2nd ed. (2004),
/// chapter 12 (bias, for times short against the Schuler period of 84 min); the variance of twice
/// integrated white noise is N² ∫₀ᵗ (t − s)² ds.
/// Times must not be negative. Cost: sensors × times.
[[nodiscard]] std::vector<BudgetRow> position_budget(View<BudgetSensor> sensors,
                                                     View<double> times_s);

/// The sensors of table 2.1: one for each grade, its bias without uncertainty, no noise.
[[nodiscard]] std::vector<BudgetSensor> grade_sensors();

}  // namespace proofmass::estimate
