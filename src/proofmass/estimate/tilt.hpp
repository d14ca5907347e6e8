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
#include "proofmass/estimate/tilt_angles.hpp"
#include "proofmass/sensor/gravity.hpp"
#include "proofmass/sensor/sensor_model.hpp"
#include "proofmass/signal/rests.hpp"

// Roll and pitch from gravity, at rest and on a moving base.
namespace proofmass::estimate {

/// What one sensor reads, in SI; NaN where there is no reading, empty where there is no channel.
struct TiltRecord {
  std::vector<double> time_s;                     ///< ascending; empty: the rate is not known
  std::array<std::vector<double>, 3> accel_mps2;  ///< specific force: +g upwards at rest
  std::array<std::vector<double>, 3> rate_radps;  ///< gyroscope: all three, or none
  /// Step of the converter behind an axis, 0: none; absent: as the values show.
  std::array<std::optional<double>, 3> step_mps2{};
};

enum class TiltBase { automatic, still, moving };

struct TiltOptions {
  Uncertain gravity_mps2{standard_gravity_mps2, sensor::gravity_std_on_earth_mps2};
  TiltBase base = TiltBase::automatic;  ///< automatic: still where rests make up nine tenths
  /// Of the sensor that the readings went through; its uncertainty goes into that of the angles.
  std::optional<sensor::Calibration> calibration = std::nullopt;
  sensor::NoiseModel noise = {};  ///< its flicker and walk add to what the recording shows
  /// Of each axis: without calibration its bias, with one what that may have changed by since.
  /// Absent: judged by how far the force at rest departs from gravity.
  std::optional<double> bias_std_mps2 = std::nullopt;
  double rate_bias_std_radps = 0.05;       ///< of the gyroscope's bias at the start
  double rate_bias_walk_radps_rts = 2e-5;  ///< what it walks in the root of a second
  double rate_scale_std = 0.05;            ///< relative error of a turn
  std::optional<double> shortest_rest_s = std::nullopt;
  Progress progress = {};
};

/// Where the variance of the direction comes from: standard deviations in rad.
struct TiltShares {
  double noise = 0.0, calibration = 0.0, alignment = 0.0;
};

/// One stretch in which the sensor lay still.
struct TiltRest {
  std::size_t first = 0, last = 0;         ///< samples, inclusive
  Mat<3> force_mps2 = Mat<3>::Zero();      ///< mean; NaN on an axis that is not there
  Mat<3> rounding_m2ps4 = Mat<3>::Zero();  ///< variance of what the converter's steps hide
  std::optional<Uncertain> norm_mps2{};    ///< of the mean, where there are three axes
  TiltAngles angles{};
  TiltShares shares{};
};

/// What the filter of a moving base takes the motion for, found from the recording.
struct TiltMotion {
  bool gyroscope = false;
  /// With gyroscope its white noise in rad/s/√Hz; without, the angular acceleration that turns the
  /// base, as white noise in rad/s²/√Hz.
  double drive = 0.0;
  double accel_std_mps2 = 0.0;    ///< acceleration of the base, median over the motion
  double accel_time_s = 0.0;      ///< its time constant
  double reading_std_mps2 = 0.0;  ///< white noise of a reading in motion, vibration included
  double rest_std_mps2 = 0.0;     ///< the same at rest, of white noise as strong at low frequency
  double gravity_mps2 = 0.0;      ///< norm of the force at rest, or as given where there is none
  double log_likelihood = 0.0;
};

/// One entry for each sample. Angles are NaN where they are not defined, standard deviations where
/// the angle is.
struct TiltSeries {
  std::vector<double> time_s;
  std::vector<double> roll_rad, pitch_rad, roll_std_rad, pitch_std_rad;  ///< given all readings
  std::vector<double> filtered_roll_rad, filtered_pitch_rad;             ///< given those up to it
  std::vector<double> filtered_roll_std_rad, filtered_pitch_std_rad;
  /// Unit vector upwards in sensor axes, given all readings; NaN where an axis is missing.
  std::array<std::vector<double>, 3> up;
  /// Weight that the filter gave the reading, 1: all; 0 where there is none.
  std::vector<float> weight;
  std::vector<unsigned char> resting;  ///< 1 within a rest
};

struct TiltSolution {
  std::size_t samples = 0;    ///< in the recording
  std::size_t unusable = 0;   ///< of them without a reading on every channel
  std::size_t told_less = 0;  ///< readings that lost half of their weight or more
  std::size_t axes = 0;
  bool moving = false;
  TiltAngles final{};   ///< of the last rest, or of the last sample where the base moves
  TiltShares shares{};  ///< of it
  std::vector<TiltRest> rests;
  double bias_std_mps2 = 0.0;          ///< TiltOptions::bias_std_mps2, as given or as judged
  std::optional<TiltMotion> motion{};  ///< where the base moves
  std::optional<std::array<Uncertain, 3>> rate_bias_radps{};  ///< at the end, with gyroscope
  std::optional<Consistency> consistency{};                   ///< of the filter in motion
  TiltSeries series;
  std::vector<Note> notes;
};

/// Roll and pitch (tilt_angles.hpp) of a sensor by the direction of gravity.
///
/// At rest: the mean over each rest. Its variance is that of batch means, which counts correlated
/// noise, with what the sensor file says of flicker and walk over that time; to it come the
/// covariance of the calibration at that force and the alignment of the case (tilt_rest.hpp).
///
/// On a moving base: an extended Kalman filter and the fixed-interval smoother (kalman.hpp) over
///
///     g' = exp(−[(ω − b) Δ]×) g,   a' = e^(−Δ/τ) R a + w,   b' = b + w_b,   f = g + a + n,
///
/// g being gravity's reaction in sensor axes, so that no orientation is singular, and a the
/// acceleration of the base, which turns in the sensor as g does. Without gyroscope ω is that of a
/// great circle, driven by white angular acceleration. The variance of a rises with the square of
/// what the force departed of late from a mean that turns with the sensor (tilt_accel.hpp), so that
/// the accelerometer is told less while the base is shaken; and a reading loses weight beyond three
/// standard deviations of its innovation (Huber). Within rests g stands, a is 0, and the gyroscope
/// reads its bias. Strength and time constant of a are read off the scatter of the force, the
/// gyroscope's noise off rests; the angular acceleration without gyroscope is that of largest
/// likelihood of the innovations.
///
/// Source: F. L. Markley, J. L. Crassidis, Fundamentals of Spacecraft Attitude Determination and
/// Control (2014), section 6.2, for vector states; A. C. Harvey, Forecasting, Structural Time
/// Series Models and the Kalman Filter (1989), section 3.4, for the likelihood; P. J. Huber, Robust
/// Statistics (1981), section 4.5.
/// Errors: invalid_argument (no axis, lengths that differ, time that does not ascend),
/// too_few_samples (no reading; fewer than 50 on a moving base), not_observable (a moving base
/// without time or with fewer than three axes; no rest and no time).
/// Cost: some 20 µs a sample.
[[nodiscard]] Result<TiltSolution> estimate_tilt(const TiltRecord& record,
                                                 const TiltOptions& options);

}  // namespace proofmass::estimate
