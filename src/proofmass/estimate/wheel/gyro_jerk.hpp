#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/fit.hpp"

// How irregular a wheel's motion is at each time, from its gyroscope.
namespace proofmass::estimate {

/// White jerk, rad²/s⁵, that the last 40 ms of a gyroscope show beyond its noise. A wheel pushed by
/// hand coasts most of the time, and noise parameters of the whole recording are too small in the
/// pushes: the gyroscope would be rejected there, and its constants and the rolling radius absorb
/// what is motion. From the second difference Δ of the speed over h = 20 ms, or a step if that is
/// longer: white jerk of density q gives it the variance 2 q h³ / 3, white noise 6 σ².
class GyroJerk {
 public:
  /// Consecutive measurements that have to show a jerk. With two, a single outlier is ignored, and
  /// the density is somewhat smaller.
  enum class Evidence { one, two };

  /// `rate_hz` of the measurements, > 0.
  GyroJerk(double rate_hz, double noise_variance, Evidence evidence = Evidence::one);

  /// The density up to this measurement; decays within 40 ms after the last irregularity. NaN, and
  /// the rows that the time shows to be lost, are missing in the differences: a change of speed
  /// across a gap of more than h is no jerk.
  [[nodiscard]] double add(double time_s, double speed_radps);

 private:
  /// Appends to the ring; updates the density where its speeds exist.
  void put(double speed_radps);

  double rate_hz_;
  Evidence evidence_;
  std::size_t apart_;         ///< measurements in h
  double per_square_;         ///< from Δ² to the density
  double noise2_;             ///< Δ² that noise explains
  double decay_;              ///< from one measurement to the next
  std::vector<double> last_;  ///< a ring of 2 `apart_` + 1 speeds, NaN where missing
  std::size_t at_ = 0;        ///< of the oldest in the ring
  double last_s_ = no_value;
  double second_ = no_value;  ///< the last second difference
  double psd_ = 0.0;
};

/// Sets WheelEpoch::jerk_psd, if there is a gyroscope.
void mark_jerks(WheelReadings& readings);

}  // namespace proofmass::estimate
