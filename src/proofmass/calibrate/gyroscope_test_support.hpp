#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/multi_position_test_support.hpp"

// Recordings of a sensor that is turned by hand between positions, by formulas and an integration
// that are not the estimator's.
namespace proofmass::calibrate::test {

/// A gyroscope and its surroundings.
struct GyroscopeTruth {
  GyroscopeVector p = GyroscopeVector::Zero();            ///< in the order of the parameters
  double sample_std = 0.0;                                ///< white noise of one sample, reading
  double walk = 0.0;                                      ///< random walk of the bias, reading/√s
  Eigen::Vector3d earth_radps = Eigen::Vector3d::Zero();  ///< in the frame of the ground, z up

  /// Reading at this rate and specific force, of the accelerometer's frame.
  [[nodiscard]] Eigen::Vector3d reading(const Eigen::Vector3d& omega,
                                        const Eigen::Vector3d& force) const {
    Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
    T(0, 1) = -p(6);
    T(0, 2) = p(7);
    T(1, 2) = -p(8);
    const Eigen::Vector3d rho = p.segment<3>(9);
    const double angle = rho.norm();
    const Eigen::Vector3d own =
        angle > 0.0 ? Eigen::Vector3d(Eigen::AngleAxisd(-angle, rho / angle) * omega) : omega;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> G(p.data() + 12);
    return p.segment<3>(3).cwiseProduct(T.inverse() * own) + p.head<3>() + G * force;
  }
};

/// Parameters of a hand-held motion.
struct Turning {
  std::size_t rests = 20;
  double rate_hz = 100.0, rest_s = 3.0, motion_s = 2.5;
  double lever_m = 0.03;  ///< from the pivot to the accelerometer
  double least_rad = 1.0, most_rad = 2.6;
  std::vector<Eigen::Vector3d> axes = {};  ///< of the turns, in the sensor; empty: random
  double accel_std_mps2 = 0.005;
};

struct SimulatedRecording {
  GyroscopeSession session;
  Parameters accel = Parameters::Zero();
  Eigen::Vector3d mean_drift = Eigen::Vector3d::Zero();  ///< of the bias, over the rests
};

/// A sensor near rad/s: bias of 0.5 °/s, scale errors of 1 %, angles of 10 mrad, G of 0.1 °/s/g.
inline GyroscopeTruth drawn_gyroscope(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  GyroscopeTruth out;
  for (Eigen::Index k = 0; k < 21; ++k) {
    const double size = k < 3 ? 0.009 : k < 12 ? 0.01 : 1.7e-4;
    out.p(k) = (k >= 3 && k < 6 ? 1.0 : 0.0) + size * normal(random);
  }
  out.sample_std = 1e-3;
  return out;
}

/// The rate at phase 0 … 1 of a motion: a minimum-jerk turn about `axis`, with a wobble about the
/// others that starts and ends at rest too.
inline Eigen::Vector3d hand_rate(double phase,
                                 double motion_s,
                                 const Eigen::Vector3d& turn,
                                 const Eigen::Vector3d& wobble) {
  if (phase <= 0.0 || phase >= 1.0) return Eigen::Vector3d::Zero();
  const double bell = 30.0 * phase * phase * (1.0 - phase) * (1.0 - phase);
  const double swing = std::sin(2.0 * std::numbers::pi * 3.0 * phase);
  return bell / motion_s * (turn + swing * wobble);
}

inline Eigen::Vector3d drawn_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return {x, y, z};
}

/// Attitude, rate and force of each sample, then both sensors' readings.
class HandTurner {
 public:
  HandTurner(const GyroscopeTruth& truth, const Turning& turning, std::mt19937_64& random)
      : truth_(truth), turning_(turning), random_(random) {
    out_.accel = Parameters::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
      out_.accel(k) = 0.1 * normal_(random_);
      out_.accel(3 + k) = 1.0 + 0.01 * normal_(random_);
      out_.accel(6 + k) = 0.005 * normal_(random_);
    }
    attitude_ =
        Eigen::Quaterniond(Eigen::AngleAxisd(6.0 * normal_(random_), drawn_direction(random_)));
  }

  SimulatedRecording run() {
    const auto at_rest = static_cast<std::size_t>(turning_.rest_s * turning_.rate_hz);
    for (std::size_t k = 0; k < turning_.rests; ++k) {
      if (k > 0) turn(k);
      const std::size_t first = out_.session.time_s.size();
      for (std::size_t n = 0; n < at_rest; ++n)
        sample(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), true);
      out_.session.rests.push_back({first, out_.session.time_s.size() - 1});
    }
    return out_;
  }

 private:
  // Classical Runge–Kutta of dq/dt = ½ q ω, eight steps a sample.
  void turn(std::size_t k) {
    const Eigen::Vector3d axis =
        turning_.axes.empty() ? drawn_direction(random_) : turning_.axes[k % turning_.axes.size()];
    std::uniform_real_distribution<double> size(turning_.least_rad, turning_.most_rad);
    const Eigen::Vector3d turn = size(random_) * axis;
    const bool free = turning_.axes.empty();
    const Eigen::Vector3d wobble = free ? Eigen::Vector3d(0.2 * drawn_vector(random_))
                                        : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const auto samples = static_cast<std::size_t>(turning_.motion_s * turning_.rate_hz);
    const auto rate = [&](double s) {
      return hand_rate(s / turning_.motion_s, turning_.motion_s, turn, wobble);
    };
    const double dt = 1.0 / turning_.rate_hz, h = dt / 8.0;
    for (std::size_t n = 0; n + 1 < samples; ++n) {
      for (int part = 0; part < 8; ++part) step(rate, static_cast<double>(n) * dt + part * h, h);
      const double s = static_cast<double>(n + 1) * dt;
      sample(rate(s), (rate(s + 1e-5) - rate(s - 1e-5)) / 2e-5);
    }
    const double s = static_cast<double>(samples - 1) * dt;
    for (int part = 0; part < 8; ++part) step(rate, s + part * h, h);
  }

  template <class Rate>
  void step(const Rate& rate, double s, double h) {
    const auto slope = [](const Eigen::Vector4d& q, const Eigen::Vector3d& w) -> Eigen::Vector4d {
      const Eigen::Quaterniond product =
          Eigen::Quaterniond(q) * Eigen::Quaterniond(0.0, w.x(), w.y(), w.z());
      return 0.5 * product.coeffs();
    };
    const Eigen::Vector4d q = attitude_.coeffs();
    const Eigen::Vector4d k1 = slope(q, rate(s)), k2 = slope(q + 0.5 * h * k1, rate(s + 0.5 * h)),
                          k3 = slope(q + 0.5 * h * k2, rate(s + 0.5 * h)),
                          k4 = slope(q + h * k3, rate(s + h));
    attitude_.coeffs() = (q + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)).normalized();
  }

  void sample(const Eigen::Vector3d& omega, const Eigen::Vector3d& alpha, bool at_rest = false) {
    const Eigen::Vector3d lever(turning_.lever_m, -turning_.lever_m, 0.5 * turning_.lever_m);
    const Eigen::Vector3d force = attitude_.inverse() * Eigen::Vector3d(0.0, 0.0, g) +
                                  omega.cross(omega.cross(lever)) + alpha.cross(lever);
    drift_ += truth_.walk / std::sqrt(turning_.rate_hz) * drawn_vector(random_);
    if (at_rest) out_.mean_drift += drift_ / rest_samples();
    const Eigen::Vector3d earth = attitude_.inverse() * truth_.earth_radps;
    const Eigen::Vector3d rate =
        truth_.reading(omega + earth, force) + drift_ + truth_.sample_std * drawn_vector(random_);
    const Eigen::Vector3d accel =
        reading(out_.accel, force) + turning_.accel_std_mps2 * drawn_vector(random_);
    GyroscopeSession& session = out_.session;
    session.time_s.push_back(static_cast<double>(session.time_s.size()) / turning_.rate_hz);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      session.rate[axis].push_back(rate(static_cast<Eigen::Index>(axis)));
      session.accel[axis].push_back(accel(static_cast<Eigen::Index>(axis)));
    }
  }

  [[nodiscard]] double rest_samples() const {
    return static_cast<double>(turning_.rests) * std::floor(turning_.rest_s * turning_.rate_hz);
  }

  GyroscopeTruth truth_;
  Turning turning_;
  std::mt19937_64& random_;
  std::normal_distribution<double> normal_;
  Eigen::Quaterniond attitude_;
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();
  SimulatedRecording out_;
};

inline SimulatedRecording simulate(const GyroscopeTruth& truth,
                                   const Turning& turning,
                                   std::mt19937_64& random) {
  return HandTurner(truth, turning, random).run();
}

/// The accelerometer's calibration by its own positions, and the session with their means.
inline MultiPosition accelerometer_of(GyroscopeSession& session) {
  const PoseMeans means =
      pose_means({session.accel[0], session.accel[1], session.accel[2]}, session.rests).value();
  session.poses = means.poses;
  session.pose_noise_dof = means.noise_dof;
  return calibrate_positions(
             means.poses,
             {.model = PoseModel::norm_9, .gravity_mps2 = g, .noise_dof = means.noise_dof})
      .value();
}

/// The accelerometer as it is, without uncertainty: for recordings that do not calibrate it.
inline MultiPosition exact_accelerometer(SimulatedRecording& recording) {
  GyroscopeSession& session = recording.session;
  const PoseMeans means =
      pose_means({session.accel[0], session.accel[1], session.accel[2]}, session.rests).value();
  session.poses = means.poses;
  session.pose_noise_dof = means.noise_dof;
  MultiPosition out;
  for (std::size_t k = 0; k < 9; ++k)
    out.estimate[k] = recording.accel(static_cast<Eigen::Index>(k));
  out.gravity_mps2 = g;
  return out;
}

}  // namespace proofmass::calibrate::test
