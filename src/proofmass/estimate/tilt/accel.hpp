#pragma once

#include <optional>
#include <vector>

#include "proofmass/estimate/tilt/model.hpp"

// Acceleration of the base, from the scatter of the force.
namespace proofmass::estimate {

/// The gyroscope's bias.
struct RateBias {
  Mat<3> mean_radps = Mat<3>::Zero();
  /// Standard deviation of the rotation of gravity in sensor axes that it leaves, each axis.
  double tilting_std_radps = 0.0;
};

/// m and ⟨…⟩ below, epoch by epoch.
class BaseScatter {
 public:
  struct Departure {
    Mat<3> mps2;                    ///< f − m
    std::optional<double> since_s;  ///< since the previous force; absent after a gap
  };

  /// Averaging times of the departures, and of the force to which they are relative.
  BaseScatter(double memory_s, double mean_memory_s, bool gyroscope)
      : memory_s_(memory_s), mean_memory_s_(mean_memory_s), gyroscope_(gyroscope) {}
  /// Advances to the next epoch; the rate is NaN if unknown.
  void turn(double step_s, const Mat<3>& rate_radps);
  /// Adds a finite force at that epoch.
  Departure add(const Mat<3>& force, double gravity_mps2);
  /// Restarts after a gap: the scatter is kept, the mean force is not.
  void restart() { begun_ = false; }
  /// Current covariance of the acceleration, with standard deviation `norm_std` of the norm of
  /// gravity.
  [[nodiscard]] Mat<3, 3> covariance(double gravity_mps2, double norm_std_mps2) const;
  /// Variance of the force across its mean, and how much of it the norm explains by acceleration.
  struct Across {
    double found = 0.0, explained = 0.0;
  };
  [[nodiscard]] Across across(double gravity_mps2, double norm_std_mps2) const;

 private:
  /// An exponentially weighted mean of the past.
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

/// The base's acceleration, from the scatter of the force.
struct BaseAccel {
  std::vector<Mat<3, 3>> cov_m2ps4;  ///< in sensor axes, at every epoch, over the past M
  /// Lag at which its autocorrelation falls to 1/e, at most 2 s or 0.4 T; with gyroscope, if that
  /// is longer, the time of a first-order process with its variance and low-frequency density.
  double time_s = 0.0;
  double reading_std_mps2 = 0.0;  ///< white part, from the scatter of neighbours
  /// Without gyroscope: standard deviation, along each axis across the mean force, of what the norm
  /// does not explain by acceleration, and which may be rotation; 0 if it explains most.
  double perhaps_rotation_mps2 = 0.0;
};

/// From the departure d of f from its running mean m over T, which with gyroscope rotates with the
/// sensor, corrected for the estimated gyroscope bias:
///
///     m' = exp(−[ω Δ]×) m + (1 − e^(−Δ/T)) (f − m),   D = ⟨d dᵀ⟩,   v = ⟨(|f| − G)²⟩
///
/// over M = 60 correlation times, 2 to 20 s; the part of slow departures removed by the mean is
/// added back. T is 20 s without gyroscope, and with it 10 s, or 2 s while its bias is unknown: an
/// uncertain bias, too, makes the force depart from m, and this part of the low-frequency density
/// is subtracted.
///
/// - With gyroscope the covariance is max(v, λ_max(D)) in every direction.
/// - Without gyroscope a departure may be a rotation as well as an acceleration. A horizontal
///   acceleration increases the force, by a²/2G on average, so that its variance is at most 2 G
///   (|⟨|f| − G⟩| + u), with u the standard deviation of the norm at rest: D across m, scaled down
///   to that limit, and v along every axis.
///
/// This is a heuristic, not a likelihood: in one-step prediction a smooth acceleration resembles a
/// slow one, and maximum likelihood would make it so slow that it absorbs gravity.
[[nodiscard]] BaseAccel base_accel(const TiltEpochs& epochs,
                                   const std::optional<RateBias>& rate_bias,
                                   const TiltKnown& known);

}  // namespace proofmass::estimate
