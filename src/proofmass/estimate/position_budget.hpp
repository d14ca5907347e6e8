#pragma once

#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::estimate {

/// Strengths of the noise of one axis, as the Allan variance has them (IEEE Std 952-1997, annex C);
/// 0 where there is none.
struct BudgetNoise {
  double white_mps2_rthz = 0.0;       ///< N, velocity random walk: the two-sided density
  double flicker_mps2 = 0.0;          ///< B, bias instability
  double random_walk_mps2_rts = 0.0;  ///< K
  double ramp_mps3 = 0.0;             ///< R, of unknown sign
};

/// Errors of an accelerometer that let a position found by double integration drift.
struct BudgetSensor {
  std::string name;
  Uncertain bias_mps2;  ///< left after calibration
  BudgetNoise noise = {};
};

/// Standard deviation of the position from each cause; they are independent.
struct BudgetParts {
  double bias_m = 0.0, white_m = 0.0, flicker_m = 0.0, random_walk_m = 0.0, ramp_m = 0.0;
};

struct BudgetError {
  double t_s = 0.0;
  Uncertain position_m;  ///< value from the bias; std the root sum of squares of the parts
  BudgetParts parts = {};
};

struct BudgetRow {
  std::string name;
  Uncertain bias_mps2;
  std::vector<BudgetError> errors;  ///< one for each time
  BudgetNoise noise = {};
};

/// Error of the position that double integration from rest gives after each time,
///
///     ½ b t² ± √((½ σ_b t²)² + N² t³/3 + (½ σ_B t²)² + K² t⁵/20 + (R t³/6)²),
///
///     σ_B² = (B²/π) (ln(P/(2π t)) + c),   c = 7/4 − γ,   P = max(1 h, 10 t).
///
/// Flicker has no variance without a longest period P, which is that over which the bias is taken
/// to stay known: its density B²/(π f), one-sided, weighed by 2 (t − s)/t² over the time of
/// integration, the autocovariance −(B²/π) (γ + ln(2π |Δ|/P)) and E ln |x − y| = −7/4 for x, y of
/// density 2 (1 − x). The random walk counts from the beginning of the integration: what the bias
/// did since the calibration belongs to σ_b.
///
/// Source: D. H. Titterton, J. L. Weston, Strapdown Inertial Navigation Technology, 2nd ed. (2004),
/// chapter 12 (bias, for times short against the Schuler period of 84 min); the variances of twice
/// integrated noise are N² ∫₀ᵗ (t − s)² ds and K² ∫₀ᵗ ((t − s)²/2)² ds.
/// Times must not be negative. Cost: sensors × times.
[[nodiscard]] std::vector<BudgetRow> position_budget(View<BudgetSensor> sensors,
                                                     View<double> times_s);

/// The sensors of table 2.1: one for each grade, its bias without uncertainty, no noise.
[[nodiscard]] std::vector<BudgetSensor> grade_sensors();

}  // namespace proofmass::estimate
