#pragma once

#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::estimate {

/// Noise coefficients of one axis as defined by the Allan variance (IEEE Std 952-1997, annex C); 0
/// if absent.
struct BudgetNoise {
  double white_mps2_rthz = 0.0;       ///< N, velocity random walk: the two-sided density
  double flicker_mps2 = 0.0;          ///< B, bias instability
  double random_walk_mps2_rts = 0.0;  ///< K
  double ramp_mps3 = 0.0;             ///< R, of unknown sign
};

/// Accelerometer errors that cause drift of a doubly integrated position.
struct BudgetSensor {
  std::string name;
  Uncertain bias_mps2;  ///< residual after calibration
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

/// Error of the position by double integration from rest, after each time:
///
///     ½ b t² ± √((½ σ_b t²)² + N² t³/3 + (½ σ_B t²)² + K² t⁵/20 + (R t³/6)²),
///
///     σ_B² = (B²/π) (ln(P/(2π t)) + c),   c = 7/4 − γ,   P = max(1 h, 10 t).
///
/// - Flicker has a finite variance only up to a longest period P, the time over which the bias is
///   assumed known. The terms follow from its one-sided density B²/(π f), weighted by 2 (t − s)/t²
///   over the integration time, the autocovariance −(B²/π) (γ + ln(2π |Δ|/P)) and E ln |x − y| =
///   −7/4 for x, y of density 2 (1 − x).
/// - The random walk starts with the integration: the change of the bias since the calibration
///   belongs to σ_b.
///
/// Source: D. H. Titterton, J. L. Weston, Strapdown Inertial Navigation Technology, 2nd ed. (2004),
/// chapter 12 (bias, for times short against the Schuler period of 84 min); the variances of twice
/// integrated noise are N² ∫₀ᵗ (t − s)² ds and K² ∫₀ᵗ ((t − s)²/2)² ds. Times must not be negative.
/// Cost: sensors × times.
[[nodiscard]] std::vector<BudgetRow> position_budget(View<BudgetSensor> sensors,
                                                     View<double> times_s);

/// Standard deviation of the distance between two rests, a time t_s apart, by double integration
/// with the velocity 0 at both:
///
///     √(N² t³/12 + B² t⁴/(16 π) + K² t⁵/120).
///
/// The second rest shows a constant bias, v(t)/t, so that the error of the distance is ∫ (t/2 − s)
/// a(s) ds over the noise a: a bias contributes nothing, flicker ∬ w(s) w(s') of its autocovariance
/// −(B²/π) ln |s − s'|, for which ∬ x y ln |x − y| over the unit square about 0 is −1/16. Scale
/// error and a change of tilt are not included, nor is the ramp. Source: as above.
[[nodiscard]] BudgetParts distance_between_rests(const BudgetNoise& noise, double t_s);

/// The sensors of table 2.1: one for each grade, exact bias, no noise.
[[nodiscard]] std::vector<BudgetSensor> grade_sensors();

}  // namespace proofmass::estimate
