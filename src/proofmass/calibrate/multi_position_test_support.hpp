#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"

// Random sensors and positions, by independent formulas.
namespace proofmass::calibrate::test {

inline constexpr double g = 9.80665;
inline constexpr double mg = 1e-3 * g;

/// A sensor with raw counts near 33 000: bias, scale, misalignment.
inline Parameters drawn_sensor(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Parameters truth;
  for (Eigen::Index k = 0; k < 3; ++k) {
    truth(k) = 33000.0 + 300.0 * normal(random);
    truth(3 + k) = 414.0 * (1.0 + 0.02 * normal(random));
    truth(6 + k) = 0.006 * normal(random);
  }
  return truth;
}

/// reading = diag(scale) T⁻¹ f + bias.
inline Eigen::Vector3d reading(const Parameters& truth, const Eigen::Vector3d& force) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 1) = -truth(6);
  T(0, 2) = truth(7);
  T(1, 2) = -truth(8);
  const Eigen::Vector3d along_axes = T.inverse() * force;
  return truth.segment<3>(3).cwiseProduct(along_axes) + truth.head<3>();
}

inline Eigen::Vector3d drawn_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::Vector3d v;
  do v = Eigen::Vector3d(normal(random), normal(random), normal(random));
  while (v.norm() < 0.1);
  return v.normalized();
}

struct PoseDraw {
  std::size_t count = 24;
  double noise_mps2 = 1e-4 * g;    ///< of each axis of a mean
  double claimed_mps2 = 1e-4 * g;  ///< as stated in the covariances; 0: none
  double tilt_rad = 0.03;          ///< by which a position misses its direction, about each axis
};

/// Positions spread over the sphere in a spiral, each with a placement error; `up` is the nominal
/// direction.
inline std::vector<Pose> drawn_poses(const Parameters& truth,
                                     const PoseDraw& draw,
                                     std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto three = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  std::vector<Pose> poses;
  const double turn = normal(random);
  for (std::size_t k = 0; k < draw.count; ++k) {
    const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(draw.count);
    const double angle = turn + 2.399963 * static_cast<double>(k), flat = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d meant(flat * std::cos(angle), flat * std::sin(angle), z);
    const Eigen::Vector3d turned = (meant + draw.tilt_rad * three()).normalized();
    Pose& pose = poses.emplace_back();
    pose.up = meant;
    const Eigen::Vector3d noise = draw.noise_mps2 * three();
    pose.mean = reading(truth, g * turned) + truth.segment<3>(3).cwiseProduct(noise);
    const Eigen::Vector3d claimed = draw.claimed_mps2 * truth.segment<3>(3);
    pose.mean_covariance = claimed.cwiseAbs2().asDiagonal();
  }
  return poses;
}

/// Root mean square of |f| − g over 500 new directions without noise, in m/s².
inline double error_on_new_directions(const MultiPosition& fit,
                                      const Parameters& truth,
                                      std::mt19937_64& random) {
  const Parameters p(fit.estimate.data());
  double squares = 0.0;
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector3d mean = reading(truth, g * drawn_direction(random));
    const double error = (correction(p) * (mean - p.head<3>())).norm() - g;
    squares += error * error;
  }
  return std::sqrt(squares / 500.0);
}

}  // namespace proofmass::calibrate::test
