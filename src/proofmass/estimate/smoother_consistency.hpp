#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "proofmass/core/quantity.hpp"

// Whether a smoother errs as far as it says. Its residuals are the disturbances as the whole
// recording tells them, and part what an innovation mixes: readings' noise from that of the motion.
//
//   of a reading      e = z − h x̂[k|N],         var e = R − h P[k|N] hᵀ
//   of the motion     u_i = λ_i / √Λ_ii          of estimate::Hindsight, state i, before the
//                                               transition to k is taken back: ŵ = −Q λ, and
//                                               var ŵ = Q Λ Q
//
// Each is N(0, 1) after division where Q and R are true. A mean square above 1 says that R, or the
// entry of Q, is too small: it is the sign of the likelihood's slope along it. One residual far
// off is a disturbed reading, or a knock. Source: A. C. Harvey, S. J. Koopman, J. Bus. Econ. Stat.
// 10 (1992) 377 (auxiliary residuals).
namespace proofmass::estimate {

/// Mean square of a series that hangs together. Fixed memory, no allocation.
class AuxiliaryTally {
 public:
  /// A residual and its variance. Where the variance is not above 0 nothing is told of the
  /// disturbance, and nothing counted.
  void add(double residual, double variance);

  /// With the standard deviation that its own scatter from stretch to stretch shows; absent before
  /// there are 32 stretches.
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
