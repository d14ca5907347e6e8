#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/estimate/gaussian.hpp"
#include "proofmass/estimate/rotation.hpp"
#include "proofmass/sensor/gravity.hpp"
#include "proofmass/signal/rests.hpp"

// Attitude, velocity and position of a gyroscope and an accelerometer that move together.
namespace proofmass::estimate {

/// What the two sensors read in common axes, in SI; NaN where there is no reading.
struct InertialSeries {
  std::vector<double> time_s;                     ///< ascending
  std::array<std::vector<double>, 3> rate_radps;  ///< gyroscope, as long as time_s
  std::array<std::vector<double>, 3> accel_mps2;  ///< specific force: +g upward at rest
};

/// A position that was measured: at a sample, along a direction of the world, counted from the
/// start of the stretch.
struct PositionReading {
  std::size_t sample = 0;
  Mat<3> direction = Mat<3>::UnitZ();  ///< unit vector
  double position_m = 0.0, variance_m2 = 0.0;
};

/// Densities are two-sided. What is not given is taken from the rests, and where there are none
/// from the figure named.
struct AttitudeOptions {
  double gravity_mps2 = standard_gravity_mps2;
  double gravity_std_mps2 = sensor::gravity_std_on_earth_mps2;
  std::optional<double> rate_noise_radps_rthz = std::nullopt;  ///< white; without rests 1e-3
  std::optional<double> accel_noise_mps2_rthz = std::nullopt;  ///< white; without rests 1e-2
  double rate_bias_std_radps = 0.05;       ///< of the gyroscope's bias at the start
  double rate_bias_walk_radps_rts = 2e-5;  ///< what it walks in the root of a second
  double rate_scale_std = 0.01;            ///< relative error of a turn, also of its axis
  double accel_bias_std_mps2 = 0.05;       ///< left after calibration, per axis
  double accel_bias_walk_mps2_rts = 2e-4;  ///< what it walks in the root of a second
  double accel_scale_std = 0.01;           ///< relative error of an acceleration
  double rest_speed_std_mps = 0.01;        ///< of a body that lies still, of one sample
  double rest_wander_radps_rthz = 2e-5;    ///< by which the attitude of such a body creeps, white
  /// How fast the body may be in motion, one standard deviation of each component, taken anew every
  /// so many seconds: what keeps the mean of the specific force upright where there are no rests.
  double speed_std_mps = 1.0;
  double speed_interval_s = 5.0;
  std::vector<PositionReading> positions{};  ///< ascending in their samples
  double longest_gap_s = 1.0;  ///< beyond it attitude, velocity and position start afresh
  Progress progress = {};
};

/// A symmetric 3 × 3 matrix as xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<double, 6>;

/// Samples between two gaps. Heading and position count from its start, where both are 0.
struct AttitudeStretch {
  std::size_t first, last;  ///< inclusive
};

/// What became of one of the rests.
struct RestUse {
  signal::Rest rest;
  bool used = false;
  std::string why_not;  ///< in words, where it was not used
};

/// One entry for each sample, given the whole recording; NaN where the sample belongs to no
/// stretch. World axes: z up; at the start of a
/// stretch the world's x axis lies above the sensor's x axis, or above its y axis where x stands
/// within 18° of the vertical.
struct Attitude {
  /// (w, x, y, z) of R_world_sensor, w ≥ 0 at the start and continuous from there.
  std::vector<std::array<double, 4>> quaternion;
  /// Of the error δ with R = exp(δ×) R̂, in world axes: x and y tilt the vertical, z is heading.
  std::vector<Symmetric3> attitude_cov_rad2;
  std::vector<Mat<3>> velocity_mps, position_m;  ///< world axes
  std::vector<Symmetric3> velocity_cov_m2ps2, position_cov_m2;
  std::vector<Mat<3>> filtered_velocity_mps, filtered_position_m;  ///< given the readings so far
  std::vector<Symmetric3> filtered_position_cov_m2;
  std::vector<Mat<3>> rate_bias_radps, rate_bias_std_radps;  ///< sensor axes
  std::vector<Mat<3>> accel_bias_mps2, accel_bias_std_mps2;  ///< sensor axes
  std::vector<AttitudeStretch> stretches;
  std::vector<RestUse> rests;
  std::size_t interpolated = 0;  ///< samples without a reading of both sensors, within a stretch
  double rate_noise_radps_rthz = 0.0, accel_noise_mps2_rthz = 0.0;  ///< as used
  double gravity_mps2 = 0.0;                                        ///< as given
  std::vector<float> nis;               ///< of the filter, per sample, over its readings
  std::vector<unsigned char> readings;  ///< behind each nis
  int iterations = 0;
  bool converged = false;
  std::vector<Note> notes;  ///< among them that heading is not observable
};

/// Error-state filter and fixed-interval smoother. The state is the error of attitude (in world
/// axes), velocity, position and the biases b of both sensors about a nominal motion,
///
///     R' = R exp((ω − b_g − n_g) Δ),   v' = v + (R (f − b_a − n_a) − g e_z) Δ,   p' = p + v Δ + …
///     δθ' = δθ − R Δ δb_g,   δv' = δv − (R f Δ)× δθ − R Δ δb_a,   δp' = δp + Δ δv + …
///
/// and after each pass the smoothed motion is the next nominal one, until it stands (Gauss–Newton
/// on the manifold). At a rest the attitude stands, the gyroscope reads its bias, the accelerometer
/// reads gravity, R (f − b_a) = g e_z, and the velocity reads 0. In motion the velocity is bounded
/// (speed_std_mps), so that the specific force averages to gravity over times in which it cannot
/// have changed by more; no sample needs |f| ≈ g for that. A rest in which the gyroscope turns
/// against its bias (χ², p = 1e-6) is not used. A missing reading is interpolated in time with the
/// doubt of the motion around it.
///
/// Heading is not observable: it starts at 0, and its variance grows by what the gyroscope does.
///
/// Source: F. L. Markley, Attitude error representations for Kalman filtering, J. Guid. Control
/// Dyn. 26 (2003) 311; J. Solà, Quaternion kinematics for the error-state Kalman filter (2017),
/// section 7 (global angular error); B. M. Bell, SIAM J. Optim. 4 (1994) 626, for the iteration.
/// Errors: invalid_argument (lengths that differ, time that does not ascend, rests outside),
/// too_few_samples (fewer than 2 with both sensors). Cost: O(samples), some 15 µs a sample and
/// iteration.
[[nodiscard]] Result<Attitude> estimate_attitude(const InertialSeries& series,
                                                 const std::vector<signal::Rest>& rests,
                                                 const AttitudeOptions& options);

/// Acceleration in world axes, R (f − b_a) − g e_z; NaN where there is no reading.
[[nodiscard]] std::array<std::vector<double>, 3> gravity_free_acceleration(
    const InertialSeries& series, const Attitude& attitude);

/// How far the vertical may be off, one standard deviation of the larger direction, rad.
[[nodiscard]] double inclination_std_rad(const Symmetric3& attitude_cov_rad2);

}  // namespace proofmass::estimate
