#pragma once

#include <Eigen/Core>
#include <limits>

#include "proofmass/simulate/band_limited_noise.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/wheel_motion.hpp"

namespace proofmass::simulate {

/// Motion and supply of the sensors at one time.
struct Instant {
  double t_s = std::numeric_limits<double>::quiet_NaN();
  WheelState wheel;
  Eigen::Vector3d still_mps2;  ///< force at the axle, in the wheel's axes
  double supply_v = 0.0;

  /// Force at p on the wheel, in the wheel's axes; see the equation in rig.hpp.
  [[nodiscard]] Eigen::Vector3d force_mps2(const Eigen::Vector3d& p) const;
};

/// Motion and supply of the sensors as functions of time.
class RigState {
 public:
  explicit RigState(const RigOptions& options);

  /// Computed once if consecutive channels use the same time.
  [[nodiscard]] const Instant& at(double t_s);
  [[nodiscard]] double duration_s() const { return motion_.duration_s(); }

 private:
  [[nodiscard]] double supply_v(double t_s) const;

  WheelMotion motion_;
  double gravity_mps2_, tilt_rad_, rolling_radius_m_;
  BandLimitedNoise shake_horizontal_, shake_vertical_;
  RigSupply supply_;
  double supply_phase_rad_;
  Instant now_;
};

}  // namespace proofmass::simulate
