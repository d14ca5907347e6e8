#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/filter/smoother.hpp"

// Motion along one axis with the accelerometer as known input.
//
//     moving   p' = v,   v' = a − b − n,   b' = w        n of density N², w of density q
//     at rest  p' = 0,   v = 0,            b' = w,       measurements of b
//     cruise   p' = v,   v' = 0,           b' = w,       measurements of b
//
// b jumps, with variance J, at the beginning and the end of a motion, since the sensor's attitude
// changes when it is picked up or laid down. In motion n has an additional density L, due to
// rocking.
namespace proofmass::estimate {

namespace inertial_axis {
inline constexpr int position_m = 0;
inline constexpr int velocity_mps = 1;
inline constexpr int bias_mps2 = 2;
}  // namespace inertial_axis

/// The transition from the previous epoch and the measurements there; NaN if there are none.
struct InertialEpoch {
  double dt_s = 0.0;
  bool resting = false;   ///< during the step to this epoch
  bool cruising = false;  ///< during the step, if `resting`: at constant speed instead of zero
  /// The motion begins before, ends after the step.
  bool leaves_rest = false, arrives_at_rest = false;
  /// Integrals of the measurements over the step, from zero velocity.
  double velocity_step_mps = 0.0, position_step_m = 0.0;
  double unknown_accel_m2ps3 = 0.0;  ///< density, in addition, if measurements are missing
  double velocity_std_mps = std::numeric_limits<double>::quiet_NaN();  ///< of the measurement v = 0
  double level_mps2 = std::numeric_limits<double>::quiet_NaN();  ///< a at rest, mean since before
  double level_variance = 0.0;
  /// Measured position at position_after_s after the epoch, extrapolated to constant speed: less
  /// ½ a t² unless `resting`.
  double position_m = std::numeric_limits<double>::quiet_NaN();
  double position_variance = 0.0, position_after_s = 0.0;
};

struct InertialNoise {
  double white_m2ps3 = 0.0;        ///< N², two-sided
  double motion_lean_m2ps3 = 0.0;  ///< L
  /// Upper value of L, if all additional vibration in motion is aliased, and so white.
  double shaking_m2ps3 = 0.0;
  double motion_walk_m2ps5 = 0.0;  ///< q in motion
  double motion_jump_m2ps4 = 0.0;  ///< J
  double rest_walk_m2ps5 = 0.0;    ///< q at rest
  double rest_speed_std_mps = 1e-3;
};

/// The model of this header over its epochs, for filter/smoother.hpp's filter and smoother. The
/// first epoch has no transition.
struct InertialAxis {
  static constexpr int states = 3, moving = 3, channels = 3;
  View<InertialEpoch> epochs;
  InertialNoise noise;

  [[nodiscard]] std::size_t size() const { return epochs.size(); }
  [[nodiscard]] Transition<3, 3> transition(const Mat<3>& x, std::size_t k) const;
  void measure(const Mat<3>& x, std::size_t k, Readings<3, 3>& out) const;
  void reopen(Gaussian<3>&, std::size_t) const {}
};

/// Prior at the first epoch: p = 0, v within `speed_std_mps` of `speed_mps`, b within
/// `bias_std_mps2` of `bias_mps2`.
struct InertialStart {
  double speed_mps = 0.0, speed_std_mps = 0.0;
  double bias_mps2 = 0.0, bias_std_mps2 = 10.0;
};
[[nodiscard]] FilterState<3> inertial_start(const InertialStart& start);

/// The epochs between two of `kept` combined exactly: noise, random walk and measurements of the
/// whole step are those of its parts. Only epochs without measurements and of one kind may lie
/// between.
[[nodiscard]] std::vector<InertialEpoch> join_epochs(View<InertialEpoch> epochs,
                                                     const std::vector<std::size_t>& kept);

}  // namespace proofmass::estimate
