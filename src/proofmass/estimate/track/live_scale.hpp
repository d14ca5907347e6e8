#pragma once

#include <array>
#include <cstddef>

#include "proofmass/estimate/models/inertial_1d.hpp"

// Online estimate of the errors in motion, from stop to stop.
namespace proofmass::estimate {

/// L, J and q of models/inertial_1d.hpp at scale 1. The median of track/motion_noise.hpp's prior is
/// 1e-5 for each of them; here L has the largest share, since it leaves the position least certain.
inline constexpr double usual_lean_m2ps3 = 1e-5;
inline constexpr double usual_jump_m2ps4 = 3e-6;
inline constexpr double usual_walk_m2ps5 = 1e-6;

/// Their contribution to the variance of a velocity integrated for `elapsed_s`, at scale 1.
[[nodiscard]] inline double usual_velocity_variance(double elapsed_s) {
  return elapsed_s *
         (usual_lean_m2ps3 + elapsed_s * (usual_jump_m2ps4 + elapsed_s * usual_walk_m2ps5 / 3.0));
}

/// The common scale of L, J and q. Its logarithm is normal about 0, with twice the standard
/// deviation that track/motion_noise.hpp has for a root; a closure weights each value of a grid by
/// its likelihood. track.hpp estimates the three separately, which needs all closures repeatedly.
class MotionScale {
 public:
  MotionScale();

  /// Adds a closure velocity at a stop: its variance is `known` + scale · `usual`.
  void learn(double velocity_mps, double known, double usual);
  /// Scale for which 1.96 standard deviations of a closure contain 95 % of the mixture.
  [[nodiscard]] double scale() const { return scale_; }
  /// Median of the posterior, in the logarithm.
  [[nodiscard]] double middle() const { return middle_; }

 private:
  static constexpr std::size_t points = 41;

  void settle(double known, double usual);

  std::array<double, points> value_{}, log_weight_{}, weight_{}, variance_{};
  double scale_ = 1.0, middle_ = 1.0;
};

}  // namespace proofmass::estimate
