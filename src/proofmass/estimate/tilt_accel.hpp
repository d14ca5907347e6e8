#pragma once

#include <optional>
#include <vector>

#include "proofmass/estimate/tilt_model.hpp"

// What the base does besides turning, by its scatter. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// m and ⟨…⟩ below, instant by instant.
class BaseScatter {
 public:
  /// Over how long a time a gyroscope of unknown bias may carry the mean that the force departs
  /// from.
  static constexpr double mean_memory_s = 2.0;

  struct Departure {
    Mat<3> mps2;                    ///< f − m
    std::optional<double> since_s;  ///< the force before; absent where nothing leads on from it
  };

  BaseScatter(double memory_s, bool gyroscope) : memory_s_(memory_s), gyroscope_(gyroscope) {}
  /// To the next instant; the rate is NaN where it is not known.
  void turn(double step_s, const Mat<3>& rate_radps);
  /// A force there, finite.
  Departure add(const Mat<3>& force, double gravity_mps2);
  /// σ² as it stands.
  [[nodiscard]] double variance() const;

 private:
  /// A mean of the past with weights that fall off.
  class Fading {
   public:
    void add(double value, double fade);
    [[nodiscard]] double mean() const { return weight_ > 0.0 ? sum_ / weight_ : 0.0; }

   private:
    double sum_ = 0.0, weight_ = 0.0;
  };

  double memory_s_;
  bool gyroscope_, begun_ = false;
  Fading scatter_, norm_;
  Mat<3> mean_ = Mat<3>::Zero();
  double since_s_ = 0.0;
};

/// The base's acceleration as scatter of the force.
struct BaseAccel {
  std::vector<double> std_mps2;   ///< each component, at every instant, over the past M
  double time_s = 0.0;            ///< lag at which its autocorrelation falls to 1/e, 1 s at most
  double reading_std_mps2 = 0.0;  ///< white part, by the scatter of neighbours
};

/// With gyroscope, less its bias as far as it is known, the departure of f from its running mean,
/// which turns with the sensor:
///
///     m' = exp(−[ω Δ]×) m + (1 − e^(−Δ/2 s)) (f − m),   σ² = max(⟨|f − m|²⟩/3, ⟨(|f| − G)²⟩),
///
/// over M = 60 correlation times, 2 to 20 s, less what the mean takes of slow departures; and
/// without it (|f| − G)² alone, which sees the acceleration along gravity: a base that only speeds
/// up on the level cannot then be told from one that tilts. A rule, not a likelihood: one step
/// ahead a smooth acceleration looks like a slow one, and a likelihood would make it so slow that
/// gravity drowned in it.
[[nodiscard]] BaseAccel base_accel(const TiltInstants& instants,
                                   const Mat<3>& rate_bias,
                                   double gravity_mps2);

}  // namespace proofmass::estimate
