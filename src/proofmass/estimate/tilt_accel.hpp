#pragma once

#include <optional>
#include <vector>

#include "proofmass/estimate/tilt_model.hpp"

// What the base does besides turning, by its scatter. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// m and ⟨…⟩ below, epoch by instant.
class BaseScatter {
 public:
  struct Departure {
    Mat<3> mps2;                    ///< f − m
    std::optional<double> since_s;  ///< the force before; absent where nothing leads on from it
  };

  /// Over how long a time departures are averaged, over how long a time the force they depart from.
  BaseScatter(double memory_s, double mean_memory_s, bool gyroscope)
      : memory_s_(memory_s), mean_memory_s_(mean_memory_s), gyroscope_(gyroscope) {}
  /// To the next epoch; the rate is NaN where it is not known.
  void turn(double step_s, const Mat<3>& rate_radps);
  /// A force there, finite.
  Departure add(const Mat<3>& force, double gravity_mps2);
  /// Goes on elsewhere: the scatter is kept, the force it is about is not.
  void restart() { begun_ = false; }
  /// Covariance of the acceleration as it stands, the norm of gravity being known to `norm_std`.
  [[nodiscard]] Mat<3, 3> covariance(double gravity_mps2, double norm_std_mps2) const;

 private:
  /// A mean of the past with weights that fall off.
  template <class T>
  struct Fading {
    T sum;
    double weight = 0.0;

    void add(const T& value, double fade) {
      sum = fade * sum + value;
      weight = fade * weight + 1.0;
    }
    [[nodiscard]] T mean() const { return weight > 0.0 ? T(sum / weight) : sum; }
  };

  double memory_s_, mean_memory_s_;
  bool gyroscope_, begun_ = false;
  Fading<Mat<3, 3>> scatter_{Mat<3, 3>::Zero()};
  Fading<double> norm_{0.0}, excess_{0.0};
  Mat<3> mean_ = Mat<3>::Zero();
  double since_s_ = 0.0;
};

/// The base's acceleration as scatter of the force.
struct BaseAccel {
  std::vector<Mat<3, 3>> cov_m2ps4;  ///< in sensor axes, at every epoch, over the past M
  double time_s = 0.0;               ///< lag at which its autocorrelation falls to 1/e, 2 s at most
  double reading_std_mps2 = 0.0;     ///< white part, by the scatter of neighbours
};

/// By the departure d of f from its running mean m over T, which with gyroscope turns with the
/// sensor, less the gyroscope's bias as far as it is known:
///
///     m' = exp(−[ω Δ]×) m + (1 − e^(−Δ/T)) (f − m),   D = ⟨d dᵀ⟩,   v = ⟨(|f| − G)²⟩
///
/// over M = 60 correlation times, 2 to 20 s; what the mean takes of slow departures is put back.
/// With gyroscope the covariance is max(v, λ_max(D)) in every direction. Without it a departure may
/// be a turn as well as an acceleration. A level acceleration lengthens the force, by a²/2G on
/// average, so that its variance is at most 2 G (|⟨|f| − G⟩| + u), u being the standard deviation
/// of the norm at rest: D across m, scaled down to that if it is more, and v along every axis.
/// A rule, not a likelihood: one step ahead a smooth acceleration looks like a slow one, and a
/// likelihood would make it so slow that gravity drowned in it.
[[nodiscard]] BaseAccel base_accel(const TiltInstants& instants,
                                   const Mat<3>& rate_bias,
                                   const TiltKnown& known,
                                   double mean_memory_s);

}  // namespace proofmass::estimate
