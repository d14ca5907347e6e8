#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/estimate/drive.hpp"
#include "proofmass/estimate/filter/smoother.hpp"

// State-space model of a vehicle on a plane. Private to the module.
//
// The reference point is the middle of the unsteered axle, the origin the start; x points along the
// vehicle at the start, y to its left. With v and ω the means of speed and yaw rate over a step h,
// and a wheel at (b, c) of the vehicle (b forward: the wheelbase or 0; c left: ± half the track):
//
//     x  += v h cos(ψ + ω h / 2),  y += v h sin(ψ + ω h / 2),  ψ += ω h
//     σ  += v h · direction                              distance travelled
//     Sᵢ += h √((v − ω c)² + (ω b)²) · sgn(v − ω c) e^(−ρᵢ) + slip    distance that wheel i rolled,
//                                                        if its radius were the nominal rᵢ
//     zᵢ  = Sᵢ / rᵢ − θ̇ᵢ τ                                angle of wheel i, whose clock is τ ahead
//     z_j = (1 + k_j) (ψ + δ_j) + d_j + b_j t_m − ψ̇_j τ   integrated yaw rate of gyroscope j, with
//                                                        t_m the time in motion so far
//     δ   = atan(ω b / (v − ω c))                         steering angle (0 if unsteered)
//     z_f = p₀ + R(ψ₀) (p + R(ψ) a) + wander              fix, with the antenna at a
//
// Slip is an error of the nominal distance, an angle: as one of the true distance it would be
// smaller on smaller wheels, and the most probable scale the smallest that the fixes permit.
//
// The rates θ̇ᵢ and ψ̇_j that multiply a clock's error are central differences of the measurements:
// of the estimated rate, the mean over the step before, the noise is that of the measurement
// itself, and its product with the innovation moves τ.
//
// A steered wheel rolls along its own plane, which without slip is the direction in which its
// contact point moves (Ackermann): its speed needs no measurement of the steering.
namespace proofmass::estimate::drive {

inline constexpr int most_wheels = static_cast<int>(most_drive_wheels);
inline constexpr int most_gyros = most_wheels + 1;  ///< the last is the frame's
inline constexpr int most_clocks = most_wheels + 2;

namespace at {
inline constexpr int x = 0, y = 1, heading = 2, path = 3, speed = 4, rate = 5;
inline constexpr int rolled = 6;                     // for each wheel
inline constexpr int wander = rolled + most_wheels;  // east, north
inline constexpr int track = wander + 2, base = track + 1;
inline constexpr int radius = base + 1;  // ρ, for each wheel
inline constexpr int dynamic = radius + most_wheels;
inline constexpr int drift = dynamic;  // for each gyroscope
inline constexpr int yaw_scale = drift + most_gyros;
inline constexpr int rate_bias = yaw_scale + most_gyros;
inline constexpr int antenna = rate_bias + most_gyros;  // forward, left
inline constexpr int bearing = antenna + 2;             // ψ₀
inline constexpr int origin = bearing + 1;              // p₀: east, north
inline constexpr int clock = origin + 2;                // τ, for each clock
inline constexpr int states = clock + most_clocks;
}  // namespace at

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Measurements at one epoch of the first wheel's clock; NaN where a sensor has none.
struct Epoch {
  double time_s = 0.0, dt_s = 0.0;
  double moving_s = 0.0;  ///< time in motion so far
  int direction = 0;      ///< +1 forwards, −1 backwards, 0 standing
  bool turns = false;     ///< the vehicle moves fast enough for a steering angle
  std::array<double, most_drive_wheels> angle_rad{}, angle_std_rad{}, angle_rate_radps{};
  std::array<double, most_drive_wheels + 1> yaw_rad{}, yaw_rate_radps{}, yaw_walk_rad2{};
  double fix_east_m = missing, fix_north_m = missing;
  double fix_variance_m2 = 0.0;  ///< stated by the receiver, else 0
  double fix_after_s = 0.0;      ///< time of the fix, by its clock, minus time_s
  bool fix_doubted = false;      ///< far from the path: its variance contains the distance
};

/// What is fixed while the filter runs.
struct Vehicle {
  int wheels = 0;
  std::array<double, most_drive_wheels> radius_m{};  ///< about which ρ is estimated
  std::array<double, most_drive_wheels> side{};      ///< +1 left, −1 right, 0: reference point
  std::array<bool, most_drive_wheels> steered{};
  std::array<int, most_drive_wheels + 1> clock{};  ///< of each wheel, and of the frame
  int fix_clock = 0;
  std::array<double, most_clocks> offset_s{};  ///< at which the measurements were interpolated
};

struct Noise {
  double speed_psd = 1.0;  ///< (m/s)² per second
  double rate_psd = 0.25;  ///< (rad/s)² per second
  double slip_m_per_rtm = 0.004;
  double fix_std_m = 0.15, wander_std_m = 0.7, wander_s = 30.0;
};

struct Model {
  static constexpr int states = at::states, moving = at::dynamic;
  static constexpr int channels = most_wheels + most_gyros + 4;
  using State = Mat<states>;

  const std::vector<Epoch>* epochs = nullptr;
  Vehicle vehicle;
  Noise noise;
  bool with_fixes = false;
  /// Unsteered wheels' yaw as imprecise as steered ones', so that hypotheses on which wheels steer
  /// differ in what they predict, not in the precision that they claim.
  bool comparing = false;

  [[nodiscard]] std::size_t size() const { return epochs->size(); }
  [[nodiscard]] Transition<states, moving> transition(const State& x, std::size_t k) const;
  void measure(const State& x, std::size_t k, Readings<states, channels>& out) const;
  /// The covariance is never reset: outliers are down-weighted, and the path has no second branch.
  void reopen(Gaussian<states>&, std::size_t) const {}

 private:
  void measure_wheels(const State& x, const Epoch& now, Readings<states, channels>& out) const;
  void measure_yaw(const State& x, const Epoch& now, Readings<states, channels>& out) const;
  void measure_fix(const State& x, const Epoch& now, Readings<states, channels>& out) const;
};

/// Speed at which a wheel rolls, steering angle, and their derivatives by v, ω, track and base.
struct Rolling {
  double speed = 0.0, steer = 0.0;
  Mat<4> by_speed, by_steer;
};
[[nodiscard]] Rolling rolling(const Mat<at::states>& x, double side, bool steered);

/// What is reported of an epoch: position (x, y rotated by the bearing), heading on the same chart,
/// path and speed.
inline constexpr int seen_states = 5;
[[nodiscard]] Mat<seen_states> seen(const Mat<at::states>& x);
[[nodiscard]] Mat<at::states, seen_states> seen_slopes(const Mat<at::states>& x);

/// One smoothing pass.
struct Pass {
  std::vector<Mat<at::states>> path;  ///< smoothed means
  Gaussian<at::states> end;           ///< at the last epoch
  Gaussian<at::states> start;         ///< smoothed, at the first
  /// Covariance of seen() at each epoch.
  std::vector<Mat<seen_states, seen_states>> seen_cov;
  double log_likelihood = 0.0;
  double chi2 = 0.0;  ///< Σ innovation² / variance, zero-velocity measurements included
  double nis = 0.0;
  std::size_t readings = 0, fixes = 0, fixes_used = 0;
};

/// Filter and smoother, linearised about `about` where it has a state for each epoch, else about
/// the prediction. `backwards` false: the likelihood alone.
[[nodiscard]] Pass run(const Model& model,
                       const Gaussian<at::states>& prior,
                       const std::vector<Mat<at::states>>& about,
                       bool backwards);

}  // namespace proofmass::estimate::drive
