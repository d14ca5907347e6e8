#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/so3.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"
#include "proofmass/sensor/gravity.hpp"
#include "proofmass/signal/rests.hpp"

// Attitude, velocity and position from a rigidly coupled gyroscope and accelerometer.
namespace proofmass::estimate {

/// Measurements of the two sensors in common axes, in SI; NaN where missing.
struct InertialSeries {
  std::vector<double> time_s;                     ///< ascending
  std::array<std::vector<double>, 3> rate_radps;  ///< gyroscope, as long as time_s
  std::array<std::vector<double>, 3> accel_mps2;  ///< specific force: +g upward at rest
};

/// A measured position: `after_s` from a sample, along a world direction, relative to the start of
/// the stretch.
struct PositionReading {
  std::size_t sample = 0;
  Mat<3> direction = Mat<3>::UnitZ();  ///< unit vector
  double position_m = 0.0, variance_m2 = 0.0;
  double after_s = 0.0;
};

/// Densities are two-sided. Omitted values are estimated from the rests, or without rests take the
/// defaults given below.
struct AttitudeOptions {
  double gravity_mps2 = standard_gravity_mps2;
  double gravity_std_mps2 = sensor::gravity_std_on_earth_mps2;
  std::optional<double> rate_noise_radps_rthz = std::nullopt;  ///< white; without rests 1e-3
  std::optional<double> accel_noise_mps2_rthz = std::nullopt;  ///< white; without rests 1e-2
  double rate_bias_std_radps = 0.05;                           ///< initial bias of the gyroscope
  double rate_bias_walk_radps_rts = 2e-5;                      ///< its random walk
  double rate_scale_std = 0.01;            ///< relative error of a rotation, axis included
  double accel_bias_std_mps2 = 0.05;       ///< residual after calibration, per axis
  double accel_bias_walk_mps2_rts = 2e-4;  ///< its random walk
  double accel_scale_std = 0.01;           ///< relative scale error of the accelerometer
  double rest_speed_std_mps = 0.01;        ///< velocity at rest, one sample
  double rest_creep_radps_rthz = 2e-5;     ///< attitude creep at rest, white
  /// Prior standard deviation of each velocity component in motion, renewed at this interval. It
  /// keeps the mean specific force vertical where there are no rests.
  double speed_std_mps = 1.0;
  double speed_interval_s = 5.0;
  std::vector<PositionReading> positions{};  ///< ascending sample index
  double longest_gap_s = 1.0;  ///< after a longer gap attitude, velocity and position restart
  Progress progress = {};
};

/// A symmetric 3 × 3 matrix as xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<double, 6>;

/// Samples between two gaps. Heading and position are relative to its start, where both are 0.
struct AttitudeStretch {
  std::size_t first, last;  ///< inclusive
};

/// How one of the rests was used.
struct RestUse {
  signal::Rest rest;
  bool used = false;
  std::string why_not;  ///< in words, if it was not used
};

/// One entry for each sample of the recording; NaN outside of a stretch. Smoothed unless stated
/// otherwise. World axes: z up; at the start of a stretch the world's x axis lies above the
/// sensor's x axis, or above its y axis if x is within 18° of the vertical.
struct Attitude {
  /// (w, x, y, z) of R_world_sensor, w ≥ 0 at the start and continuous from there.
  std::vector<std::array<double, 4>> quaternion;
  /// Covariance of the attitude error δ with R = exp(δ×) R̂, in world axes: x and y tilt the
  /// vertical, z is heading.
  std::vector<Symmetric3> attitude_cov_rad2;
  std::vector<Mat<3>> velocity_mps, position_m;  ///< world axes
  std::vector<Symmetric3> velocity_cov_m2ps2, position_cov_m2;
  std::vector<Mat<3>> filtered_velocity_mps, filtered_position_m;  ///< given data so far
  std::vector<Symmetric3> filtered_position_cov_m2;
  std::vector<Mat<3>> rate_bias_radps, rate_bias_std_radps;  ///< sensor axes
  std::vector<Mat<3>> accel_bias_mps2, accel_bias_std_mps2;  ///< sensor axes
  std::vector<AttitudeStretch> stretches;
  std::vector<RestUse> rests;
  std::size_t interpolated = 0;  ///< samples within a stretch that lack one of the two sensors
  double rate_noise_radps_rthz = 0.0, accel_noise_mps2_rthz = 0.0;  ///< as used
  double gravity_mps2 = 0.0;                                        ///< as given
  std::vector<float> nis;               ///< NIS of the filter, per sample, over its measurements
  std::vector<unsigned char> readings;  ///< degrees of freedom of each nis
  int iterations = 0;
  bool converged = false;
  std::vector<Note> notes;  ///< including the one that heading is not observable
};

/// Error-state filter and fixed-interval smoother. The state is the error of attitude (in world
/// axes), velocity, position and the biases b of both sensors about a nominal motion,
///
///     R' = R exp((ω − b_g − n_g) Δ),   v' = v + (R (f − b_a − n_a) − g e_z) Δ,   p' = p + v Δ + …
///     δθ' = δθ − R Δ δb_g,   δv' = δv − (R f Δ)× δθ − R Δ δb_a,   δp' = δp + Δ δv + …
///
/// After each pass the smoothed motion becomes the nominal motion, until convergence (Gauss–Newton
/// on the manifold).
///
/// - At rest: the attitude is constant, the gyroscope measures its bias, the accelerometer measures
///   gravity, R (f − b_a) = g e_z, and the velocity is 0.
/// - In motion: the velocity is bounded (speed_std_mps), so the specific force averages to gravity
///   over times in which the velocity cannot have changed by more. No sample needs |f| ≈ g.
/// - A rest in which the gyroscope departs from its bias (χ², p = 1e-6) is not used.
/// - A missing sample is interpolated in time, with a variance from the surrounding motion.
/// - Heading is not observable: it starts at 0, and its variance grows with the gyroscope's errors.
///
/// Source: F. L. Markley, Attitude error representations for Kalman filtering, J. Guid. Control
/// Dyn. 26 (2003) 311; J. Solà, Quaternion kinematics for the error-state Kalman filter (2017),
/// section 7 (global angular error); B. M. Bell, SIAM J. Optim. 4 (1994) 626, for the iteration.
/// Errors: invalid_argument (unequal lengths, non-ascending time, rests out of range),
/// too_few_samples (fewer than 2 with both sensors). Cost: O(samples), some 15 µs a sample and
/// iteration.
[[nodiscard]] Result<Attitude> estimate_attitude(const InertialSeries& series,
                                                 const std::vector<signal::Rest>& rests,
                                                 const AttitudeOptions& options);

/// Acceleration in world axes, R (f − b_a) − g e_z; NaN where a measurement is missing.
[[nodiscard]] std::array<std::vector<double>, 3> gravity_free_acceleration(
    const InertialSeries& series, const Attitude& attitude);

/// Standard deviation of the vertical along its less certain direction, rad.
[[nodiscard]] double inclination_std_rad(const Symmetric3& attitude_cov_rad2);

}  // namespace proofmass::estimate
