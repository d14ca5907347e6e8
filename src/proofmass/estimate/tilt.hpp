#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/consistency.hpp"
#include "proofmass/estimate/tilt/angles.hpp"
#include "proofmass/sensor/gravity.hpp"
#include "proofmass/sensor/sensor_model.hpp"
#include "proofmass/signal/rests.hpp"

// Roll and pitch from gravity, at rest and on a moving base.
namespace proofmass::estimate {

/// Measurements of one sensor, in SI; NaN where missing, empty for a missing channel.
struct TiltRecord {
  std::vector<double> time_s;                     ///< ascending; empty: the rate is unknown
  std::array<std::vector<double>, 3> accel_mps2;  ///< specific force: +g upwards at rest
  std::array<std::vector<double>, 3> rate_radps;  ///< gyroscope: all three, or none
  /// Quantisation step of each axis, 0: none; absent: estimated from the values.
  std::array<std::optional<double>, 3> step_mps2{};
};

enum class TiltBase { automatic, still, moving };

struct TiltOptions {
  Uncertain gravity_mps2{standard_gravity_mps2, sensor::gravity_std_on_earth_mps2};
  TiltBase base = TiltBase::automatic;  ///< automatic: static if rests make up nine tenths
  /// Calibration applied to the measurements; its uncertainty is propagated to the angles.
  std::optional<sensor::Calibration> calibration = std::nullopt;
  /// Its flicker and random walk are added to the noise of the recording.
  sensor::NoiseModel noise = {};
  /// Standard deviation of each axis's bias; with a calibration, of its change since then. Absent:
  /// from a prior, and the departure of the force at rest from gravity (tilt/bias_change.hpp).
  std::optional<double> bias_std_mps2 = std::nullopt;
  double rate_bias_std_radps = 0.05;       ///< initial bias of the gyroscope
  double rate_bias_walk_radps_rts = 2e-5;  ///< its random walk
  double rate_scale_std = 0.05;            ///< relative error of a rotation
  std::optional<double> shortest_rest_s = std::nullopt;
  Progress progress = {};
};

/// Contributions to the uncertainty of the direction: standard deviations in rad.
struct TiltShares {
  double noise = 0.0, calibration = 0.0, alignment = 0.0;
};

/// One static interval.
struct TiltRest {
  std::size_t first = 0, last = 0;         ///< samples, inclusive
  Mat<3> force_mps2 = Mat<3>::Zero();      ///< mean; NaN for a missing axis
  Mat<3> rounding_m2ps4 = Mat<3>::Zero();  ///< variance due to quantisation
  std::optional<Uncertain> norm_mps2{};    ///< norm of the mean, if there are three axes
  TiltAngles angles{};
  TiltShares shares{};
};

/// Model parameters of the motion of a moving base, estimated from the recording.
struct TiltMotion {
  bool gyroscope = false;
  /// With gyroscope: its white noise in rad/s/√Hz. Without: the angular acceleration of the base,
  /// as white noise in rad/s²/√Hz.
  double drive = 0.0;
  double accel_std_mps2 = 0.0;    ///< acceleration of the base, median over the motion
  double accel_time_s = 0.0;      ///< its time constant
  double reading_std_mps2 = 0.0;  ///< white noise of a measurement in motion, vibration included
  double rest_std_mps2 = 0.0;  ///< the same at rest, for white noise of equal low-frequency density
  double gravity_mps2 = 0.0;   ///< norm of the force at rest, or as given without a rest
  double log_likelihood = 0.0;
};

/// One entry for each sample. Angles are NaN where they are not defined; standard deviations
/// likewise.
struct TiltSeries {
  std::vector<double> time_s;
  std::vector<double> roll_rad, pitch_rad, roll_std_rad, pitch_std_rad;  ///< given all measurements
  std::vector<double> filtered_roll_rad, filtered_pitch_rad;  ///< given those up to the sample
  std::vector<double> filtered_roll_std_rad, filtered_pitch_std_rad;
  /// Unit vector upwards in sensor axes, given all measurements; NaN if an axis is missing.
  std::array<std::vector<double>, 3> up;
  /// Weight of the measurement in the filter, 1: full; 0 if missing.
  std::vector<float> weight;
  std::vector<unsigned char> resting;  ///< 1 within a rest
};

struct TiltSolution {
  std::size_t samples = 0;        ///< in the recording
  std::size_t unusable = 0;       ///< number without a measurement on every channel
  std::size_t down_weighted = 0;  ///< measurements with a weight of one half or less
  std::size_t axes = 0;
  bool moving = false;
  TiltAngles final{};   ///< at the last rest, or at the last sample of a moving base
  TiltShares shares{};  ///< contributions to `final`
  std::vector<TiltRest> rests;
  double bias_std_mps2 = 0.0;          ///< TiltOptions::bias_std_mps2, as given or as estimated
  double norm_std_mps2 = 0.0;          ///< variation of the norm at rest with the attitude
  std::optional<TiltMotion> motion{};  ///< only for a moving base
  std::optional<std::array<Uncertain, 3>> rate_bias_radps{};  ///< at the end, with gyroscope
  std::optional<Consistency> consistency{};                   ///< of the filter in motion
  TiltSeries series;
  std::vector<Note> notes;
};

/// Roll and pitch (tilt/angles.hpp) of a sensor from the direction of gravity.
///
/// At rest: the mean over each rest. Its variance is that of batch means, which accounts for
/// correlated noise, plus the sensor file's flicker and random walk over that time, the covariance
/// of the calibration at that force, and the alignment of the case (tilt/rest.hpp).
///
/// On a moving base: an extended Kalman filter and the fixed-interval smoother
/// (filter/smoother.hpp) over
///
///     g' = exp(−[(ω − b) Δ]×) g,   a' = e^(−Δ/τ) R a + w,   b' = b + w_b,   f = g + a + n,
///
/// with
///
/// - g the reaction to gravity in sensor axes, so that no orientation is singular;
/// - a the acceleration of the base, which rotates in the sensor axes as g does. Its variance rises
///   with the square of the recent departure of the force from a mean that rotates with the sensor
///   (tilt/accel.hpp), so the accelerometer is down-weighted while the base is shaken;
/// - ω measured by the gyroscope. Without one, ω is that of a great circle, driven by white angular
///   acceleration.
///
/// A measurement is down-weighted beyond three standard deviations of its innovation (Huber).
/// Within rests g is constant, a is 0, and the gyroscope measures its bias. Strength and time
/// constant of a are estimated from the scatter of the force, the gyroscope's noise from rests, the
/// angular acceleration without gyroscope by maximum likelihood of the innovations.
///
/// Source: F. L. Markley, J. L. Crassidis, Fundamentals of Spacecraft Attitude Determination and
/// Control (2014), section 6.2, for vector states; A. C. Harvey, Forecasting, Structural Time
/// Series Models and the Kalman Filter (1989), section 3.4, for the likelihood; P. J. Huber, Robust
/// Statistics (1981), section 4.5. Errors: invalid_argument (no axis, unequal lengths,
/// non-ascending time), too_few_samples (no measurement; fewer than 50 on a moving base),
/// not_observable (a moving base without time or with fewer than three axes; no rest and no time).
/// Cost: some 20 µs a sample.
[[nodiscard]] Result<TiltSolution> estimate_tilt(const TiltRecord& record,
                                                 const TiltOptions& options);

}  // namespace proofmass::estimate
