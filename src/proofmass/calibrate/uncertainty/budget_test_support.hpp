#pragma once

#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/calibrate/uncertainty/draw.hpp"
#include "proofmass/core/units.hpp"

// An analog sensor in 24 positions.
namespace proofmass::calibrate {

inline constexpr double g = standard_gravity_mps2;

// Output of an ADXL335 at 3 V in volts, with misalignments of some mrad.
inline Parameters analog_sensor() {
  Parameters p;
  p << 1.51, 1.48, 1.53, 0.0306, 0.0305, 0.0301, 4e-3, -6e-3, 8e-3;
  return p;
}

// 24 directions spread over the sphere, measured with this noise in volts.
inline std::vector<Pose> poses_of(
    const Parameters& p, double noise_v, bool known, std::uint64_t seed, double gravity_mps2 = g) {
  const Eigen::Matrix3d reading = correction(p).inverse();
  Draw draw(seed);
  std::vector<Pose> poses(24);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / 24.0;
    const double turn = 2.399963 * static_cast<double>(k);
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d up(r * std::cos(turn), r * std::sin(turn), z);
    const Eigen::Vector3d noise(draw.normal(), draw.normal(), draw.normal());
    poses[k].mean = p.head<3>() + reading * (gravity_mps2 * up) + noise_v * noise;
    poses[k].up = up;
    if (known) poses[k].mean_covariance = noise_v * noise_v * Eigen::Matrix3d::Identity();
  }
  return poses;
}

inline constexpr double noise_v = 30e-6;

inline MultiPositionOptions with_gravity(double gravity_std, double noise_dof) {
  return {.model = PoseModel::norm_9,
          .gravity_mps2 = g,
          .gravity_std_mps2 = gravity_std,
          .noise_dof = noise_dof};
}

}  // namespace proofmass::calibrate
