#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/filter/fixed_lag.hpp"
#include "proofmass/estimate/models/inertial_1d.hpp"
#include "proofmass/estimate/track/live_scale.hpp"

// The inertial filter along one axis, one epoch at a time.
namespace proofmass::estimate {

struct LiveTrackSetup {
  double white_m2ps3 = 0.0;
  double rest_walk_m2ps5 = 0.0;
  double rest_speed_std_mps = 1e-4;
  double scale_std = 0.0;
  double longest_step_s = 0.0;  ///< a longer one is a gap
  std::size_t lag = 0;          ///< epochs
};

/// Level along the axis while the sensor is at rest.
struct LiveLevel {
  double mps2 = 0.0, variance = 0.0;
  /// Squared, in any direction: its change since the previous rest, beyond noise.
  double moved_m2ps4 = 0.0;
};

struct LiveTrackSample {
  double time_s = 0.0, accel_mps2 = 0.0;
  bool resting = false;
};

struct LiveTrackRow {
  Uncertain position_m, velocity_mps;
  double smoothed_time_s = 0.0;
  Uncertain smoothed_position_m;  ///< NaN in the first `lag` epochs
};

/// Position, velocity and bias from the last epoch of a rest on.
class LiveTrackFilter {
 public:
  LiveTrackFilter(const LiveTrackSetup& setup,
                  const LiveTrackSample& begin,
                  const LiveLevel& level);

  /// `rest` is used if the sensor came to rest during the step.
  void step(const LiveTrackSample& sample, const LiveLevel& rest);

  [[nodiscard]] bool at_rest() const { return last_.resting; }
  [[nodiscard]] double time_s() const { return last_.time_s; }
  /// Whether half of the speed would remain at this stop, far more than expected: constant speed is
  /// measured as rest.
  [[nodiscard]] bool is_cruising() const;
  [[nodiscard]] LiveTrackRow row() const;

 private:
  [[nodiscard]] InertialEpoch epoch_to(const LiveTrackSample& sample, const LiveLevel& rest);
  [[nodiscard]] InertialNoise noise_of(const InertialEpoch& epoch, bool gap) const;
  [[nodiscard]] Uncertain position(const Gaussian<3>& x) const;
  void leave();
  void arrive(const LiveLevel& rest);
  void set_left_open(double variance_m2);

  LiveTrackSetup setup_;
  MotionScale scale_;
  std::array<InertialEpoch, 2> epochs_{};  ///< filter/kalman_filter.hpp takes steps to the second
  FilterState<3> state_;
  Step<3, 3, 3> step_;
  FixedLag<3> window_;
  std::vector<double> times_s_;  ///< of the window's states
  std::size_t epoch_count_ = 0;
  LiveTrackSample last_;

  // The motion since the last rest.
  double left_s_ = 0.0, left_variance_m2_ = 0.0, fastest_mps_ = 0.0;
  bool has_gap_ = false;

  double moved_s_ = 0.0, accel_square_ = 0.0;  ///< over all motion: its time, and ∫ (a − b)² dt
  double excess_variance_m2_ = 0.0;            ///< of positions, due to unexpected closures
};

}  // namespace proofmass::estimate
