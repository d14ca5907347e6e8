#pragma once

#include <Eigen/Core>

// Regressors of the fit to a rotating wheel, and a ripple of its speed.
namespace proofmass::calibrate {

/// B0, S1, C1, S2, C2, S3, C3, the coefficient of −(ω²/ω̄² − 1), S4, C4, S5, C5, S6, C6, and that of
/// cos φ φ̇/√ω̄², which represents a delay of the sensor.
inline constexpr Eigen::Index harmonic_count = 15;
inline constexpr Eigen::Index square_speed_column = 7, delay_column = 14;
inline constexpr int highest_harmonic = 6;
using Harmonics = Eigen::Matrix<double, harmonic_count, 1>;

/// The column of sin nφ; that of cos nφ follows it.
[[nodiscard]] constexpr Eigen::Index sine_column(int n) {
  return n <= 3 ? 2 * n - 1 : 2 * n;
}

/// Variables of the columns.
struct ColumnPoint {
  double phase = 0.0;                  ///< φ of the axis
  double relative_square_speed = 1.0;  ///< ω²/ω̄²
  double relative_speed = 0.0;         ///< φ̇/√ω̄²
};
[[nodiscard]] Harmonics columns_at(const ColumnPoint& point);

/// ∂E/∂φ.
[[nodiscard]] double slope_at(const Harmonics& columns, const Harmonics& harmonics);

/// ε(φ) = Σ a_n cos nφ + b_n sin nφ, n = 1 … 5: the error of a phase that follows the mean speed
/// alone. φ is the phase of the first axis; a_1, b_1, a_2, ….
inline constexpr int highest_ripple = 5;
using Ripple = Eigen::Matrix<double, 2 * highest_ripple, 1>;

struct RippleAt {
  double value = 0.0, slope = 0.0, curvature = 0.0;  ///< ε, dε/dφ, d²ε/dφ²
};
[[nodiscard]] RippleAt ripple_at(const Ripple& ripple, double phase);

}  // namespace proofmass::calibrate
