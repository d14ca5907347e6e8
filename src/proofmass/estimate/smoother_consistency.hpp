#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "proofmass/core/quantity.hpp"

// Tests whether a smoother's errors match its stated covariance. Its residuals are the disturbances
// given the whole recording. They separate what an innovation mixes: measurement noise and process
// noise.
//
//   measurement   e = z − h x̂[k|N],         var e = R − h P[k|N] hᵀ
//   motion        u_i = λ_i / √Λ_ii          of estimate::BackwardInformation, state i, before the
//                                            transition to k is taken back: ŵ = −Q λ, and
//                                            var ŵ = Q Λ Q
//
// Each is N(0, 1) after division if Q and R are correct. A mean square above 1 means that R, or the
// entry of Q, is too small: it is the sign of the likelihood's derivative. A single outlier is a
// disturbed measurement, or a shock. Source: A. C. Harvey, S. J. Koopman, J. Bus. Econ. Stat. 10
// (1992) 377 (auxiliary residuals).
namespace proofmass::estimate {

/// Mean square of a correlated series. Fixed memory, no allocation.
class AuxiliaryTally {
 public:
  /// Adds a residual and its variance. Ignored if the variance is not positive, since the data then
  /// contain no information on the disturbance.
  void add(double residual, double variance);

  /// Mean square with the standard deviation from its scatter between stretches; absent below 32
  /// stretches.
  [[nodiscard]] std::optional<Uncertain> mean_square() const;
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Largest |residual|/√variance.
  [[nodiscard]] double furthest() const { return furthest_; }

 private:
  /// Stretches of 2^i residuals.
  struct Level {
    double half = 0.0;
    bool has_half = false;
    std::size_t count = 0;
    double sums = 0.0, squares = 0.0;  ///< of the sums of squares over stretches
  };
  std::array<Level, 32> levels_{};
  std::size_t count_ = 0;
  double squares_ = 0.0, furthest_ = 0.0;
};

}  // namespace proofmass::estimate
