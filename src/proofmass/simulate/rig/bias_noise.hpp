#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/random.hpp"

namespace proofmass::simulate {

/// Flicker noise and random walk of a bias as a process in continuous time. It can be evaluated at
/// a time or as a mean over an interval, with the joint distribution of the one process.
///
/// - Flicker: a sum of first-order Markov processes x_j with time constants T_j in geometric
///   progression, ratio ρ = 4, from 20 ms to 15 days, each of variance B² ln ρ/π. Between those
///   times its two-sided density is B²/(2π f). It is stationary from the start.
/// - The walk starts at 0.
///
/// Source: A. van der Ziel, Physica 16 (1950) 359 (the sum); IEEE Std 952-1997, annex C (B, K).
class BiasNoise {
 public:
  struct Strength {
    double flicker_mps2 = 0.0;   ///< B
    double walk_mps2_rts = 0.0;  ///< K
  };
  BiasNoise(const Strength& strength, const Random& random);

  [[nodiscard]] double value_mps2() const;
  /// Advances time by dt. Steps that are equal to within rounding share their coefficients.
  void pass(double dt_s);
  /// Advances time by dt > 0; returns the mean over it.
  double mean_over(double dt_s);

 private:
  std::vector<double> markov_;  ///< x_j
  double std_ = 0.0;            ///< standard deviation of each x_j
  double walk_ = 0.0, walk_rate_ = 0.0;
  struct Step {
    double lost, draw;  ///< step of a process: −lost x + draw · normal
  };
  double step_s_ = 0.0;
  std::vector<Step> steps_;  ///< one per process, for the current step
  Random draws_;
};

}  // namespace proofmass::simulate
