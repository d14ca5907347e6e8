#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "proofmass/calibrate/multi_position_test_support.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/calibrate/session_noise.hpp"
#include "proofmass/core/chi_square.hpp"

// Recordings of a sensor placed by hand while its bias drifts, from an independent generator:
// flicker noise as relaxation processes spaced by an octave and a half, a random walk as a sum of
// steps.
namespace proofmass::calibrate::test {

struct Session {
  int positions = 18;
  double white_mps2 = 0.01;    ///< per sample, at 100 Hz
  double flicker_mps2 = 0.0;   ///< B
  double walk_mps2_rts = 0.0;  ///< K
  double shortest_s = 3.0, longest_s = 5.0;
};

struct Recorded {
  std::array<std::vector<double>, 3> axes;
  std::vector<Dwell> rests;
  Parameters truth;  ///< bias: mean of the session
};

class DriftingBias {
 public:
  DriftingBias(const Session& session, std::mt19937_64& random) : random_(random) {
    constexpr double apart = 3.0, rate_hz = 100.0;
    // One-sided spectrum h/f with B² = π h; each process holds h ln(apart).
    const double part =
        std::sqrt(session.flicker_mps2 * session.flicker_mps2 / M_PI * std::log(apart));
    for (double tau_s = 0.02; tau_s < 3e4; tau_s *= apart) {
      const double kept = std::exp(-1.0 / (rate_hz * tau_s));
      kept_.push_back(kept);
      push_.push_back(part * std::sqrt(1.0 - kept * kept));
      state_.emplace_back(part * three());
    }
    step_ = session.walk_mps2_rts / std::sqrt(rate_hz);
  }
  Eigen::Vector3d next() {
    walk_ += step_ * three();
    Eigen::Vector3d sum = walk_;
    for (std::size_t k = 0; k < state_.size(); ++k) {
      state_[k] = kept_[k] * state_[k] + push_[k] * three();
      sum += state_[k];
    }
    return sum;
  }

 private:
  Eigen::Vector3d three() {
    const double x = normal_(random_), y = normal_(random_), z = normal_(random_);
    return {x, y, z};
  }
  std::mt19937_64& random_;
  std::normal_distribution<double> normal_;
  std::vector<double> kept_, push_;
  std::vector<Eigen::Vector3d> state_;
  Eigen::Vector3d walk_ = Eigen::Vector3d::Zero();
  double step_ = 0.0;
};

inline Recorded recorded(const Session& session, std::mt19937_64& random) {
  constexpr double rate_hz = 100.0;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(session.shortest_s, session.longest_s);
  Recorded out;
  for (Eigen::Index k = 0; k < 3; ++k) {
    out.truth(k) = 0.3 * normal(random);
    out.truth(3 + k) = 1.0 + 0.01 * normal(random);
    out.truth(6 + k) = 0.01 * normal(random);
  }
  DriftingBias bias(session, random);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t samples = 0;
  for (int position = 0; position < session.positions; ++position) {
    const Eigen::Vector3d force = g * drawn_direction(random);
    const auto dwell = static_cast<std::size_t>(rate_hz * even(random));
    out.rests.push_back({samples, samples + dwell - 1});
    // Between two rests the hand moves it for 0.8 s, which contains no information.
    for (std::size_t k = 0; k < dwell + 80; ++k, ++samples) {
      const Eigen::Vector3d slow_noise = bias.next();
      sum += slow_noise;
      const Eigen::Vector3d mean = reading(out.truth, force) + slow_noise;
      for (std::size_t axis = 0; axis < 3; ++axis)
        out.axes[axis].push_back(mean(static_cast<Eigen::Index>(axis)) +
                                 session.white_mps2 * normal(random));
    }
  }
  out.truth.head<3>() += sum / static_cast<double>(samples);
  return out;
}

struct SessionCoverage {
  int fits = 0, suspects = 0;
  std::array<int, 3> inside{};  ///< for biases, scales, angles; three per fit
  double largest_z = 0.0;       ///< in standard deviations of a normal distribution

  [[nodiscard]] double share(std::size_t kind) const { return inside[kind] / (3.0 * fits); }
};

inline SessionCoverage coverage_of(const Session& session, int runs) {
  SessionCoverage out;
  std::mt19937_64 random(7);
  for (int run = 0; run < runs; ++run) {
    const Recorded made = recorded(session, random);
    const PoseMeans means =
        pose_means({made.axes[0], made.axes[1], made.axes[2]}, made.rests).value();
    MultiPositionOptions options{
        .model = PoseModel::norm_9, .gravity_mps2 = g, .noise_dof = means.noise_dof};
    const auto noise = session_noise(means.poses, {&means.session, 1}, options);
    if (!noise) continue;
    options.between = noise->between;
    const Result<MultiPosition> fit = calibrate_positions(noise->poses, options);
    if (!fit) continue;
    ++out.fits;
    for (const PoseResidual& pose : fit->poses) out.suspects += pose.suspect;
    const double t = student_t_quantile(0.975, fit->dof);
    for (std::size_t k = 0; k < 9; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const double z =
          std::abs(fit->estimate[k] - made.truth(row)) / std::sqrt(fit->covariance(row, row));
      out.inside[k / 3] += z <= t;
      out.largest_z = std::max(out.largest_z, z * 1.96 / t);
    }
  }
  return out;
}

}  // namespace proofmass::calibrate::test
