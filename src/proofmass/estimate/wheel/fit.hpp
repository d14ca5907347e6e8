#pragma once

#include <array>
#include <optional>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/estimate/wheel/model.hpp"

// From planar measurements to the wheel's angle: initial motion, noise, lever arms and constants,
// then the smoother. The steps of estimate_wheel().
namespace proofmass::estimate {

/// The measurements of one or two sensors on one time line.
struct WheelReadings {
  double gravity_mps2 = standard_gravity_mps2;  ///< its component in the plane of the wheel
  double gravity_std_mps2 = 0.0;                ///< due to the unknown axle tilt
  std::optional<double> given_rolling_radius_m;
  std::optional<Uncertain> found_rolling_radius_m{};  ///< by an encoder
  Uncertain rolling_radius_m{};                       ///< as set by assume_rolling_radius()
  Uncertain delay_s{};                                ///< of the sensors' filters
  double phase_rad = 0.0;  ///< of the second sensor against the first, current estimate
  RippleOrders orders = first_orders;
  /// The wheel turns at one speed only, as an encoder shows; then nothing shows a lever arm.
  bool one_speed = false;
  /// The hub vibrates by more than a sensor's noise, or more in motion than at rest, as under a
  /// vehicle; set by settle_variance().
  bool shakes = false;
  std::vector<double> time_s;
  std::vector<WheelEpoch> epochs;
  std::vector<PlanarReadings> sensors;
  std::optional<EncoderReadings> encoder{};

  /// 1 / mean step, without gaps; 0 if there is no step.
  [[nodiscard]] double rate_hz() const;
};

/// The measurements averaged over `each` epochs: equivalent to all of them if the wheel turns
/// little meanwhile, at a fraction of the cost.
[[nodiscard]] WheelReadings averaged(const WheelReadings& readings, std::size_t each);

/// Prior standard deviation of each part of the ripple, about zero: a wheel driven by hand or by a
/// motor.
inline constexpr double ripple_share = 0.02;

/// Prior standard deviations of a sensor's constants, about zero.
struct ConstantsPrior {
  double bias_mps2 = 0.5, scale = 0.1, skew_rad = 0.03, phase_rad = 0.5, place_m = 0.3;
  double ripple = 0.0;  ///< of each part, relative to the speed
  double gyro_bias_radps = 0.1, gyro_scale = 0.03;
  double axle_slope = 0.05;             ///< as a bias along the axle leaves it
  std::array<double, 2> axle_slopes{};  ///< their means, of each gyroscope
  double rolling_m = 0.0;               ///< of the rolling radius; 0: not estimated
  double encoder_offset_rad = 0.5;
  EncoderErrors encoder_errors_rad{};  ///< with their means
};

/// Prior for less than one turn: gravity covers only part of its circle, on which bias, scale and
/// angle are not separable, so the prior is tighter.
inline constexpr ConstantsPrior short_way_prior{0.2, 0.01, 0.01, 0.5, 0.1};

/// Two independent estimates of one quantity, weighted by their precision.
[[nodiscard]] Uncertain combined(const Uncertain& a, const Uncertain& b);

/// Prior standard deviation of the rolling radius about its assumed value, where a gyroscope makes
/// it observable. Of a wheel that does not shake it is not estimated (0), once that is known: on a
/// bench it would resemble scale and bias of the gyroscope.
[[nodiscard]] double rolling_prior_std_m(const WheelReadings& readings, bool shakes_known);

/// The rolling radius as given; or assumed from the vibration, a vehicle's, uniform between 0 and
/// 0.4 m, or a bench's 0, with the uncertainty of a small, smooth wheel, and improved by the one
/// found.
void assume_rolling_radius(WheelReadings& readings);

/// Initial motion of a filter.
struct Beginning {
  double angle_rad = 0.0, angle_std_rad = 0.6;
  double speed_radps = 0.0, speed_std_radps = 1.0;
};

/// Current trajectory, and the parameters with which it was found.
struct WheelTrack {
  Beginning beginning;
  WheelNoise noise;
  WheelPath path;
  bool tuned = false;  ///< the noise, to the recording
  double lost = 1.0;   ///< share of unexplained measurements, 0 … 1
};

/// Eight measurements a turn: the limit of the search and of the result.
[[nodiscard]] constexpr double fastest_radps(double rate_hz) {
  return rate_hz * rad_per_turn / 8.0;
}

/// Tracks a single sensor's phase through the recording with the first suitable noise parameters,
/// from a grid of initial speeds and angles, since at speed and off the axle the first measurements
/// do not show the direction of gravity. Sets the measurements' variance. `first` of the
/// wheel_seeks sets of noise parameters are skipped if they have failed before.
[[nodiscard]] WheelTrack find_track(WheelReadings& readings, std::size_t first = 0);
inline constexpr std::size_t wheel_seeks = 4;

/// Whether gravity is in the direction where the track of a single sensor puts it, in nine tenths
/// of at least four seconds. A speed that ripples strongly leaves many measurements unexplained on
/// the right track too.
[[nodiscard]] bool shows_gravity(const WheelReadings& readings, const WheelTrack& track);

/// An interval in which the predicted angle is less certain than lost_prediction_rad, or in which
/// the measurements do not show gravity where it is predicted: the first and the last such epoch.
struct WheelDoubt {
  std::size_t first = 0, last = 0;
  std::size_t widest = 0;               ///< where the prediction is least certain
  Gaussian<wheel::moving> predicted{};  ///< that prediction, of the dynamic states
};

struct WheelFit {
  /// All static states, in the state's order from wheel::first_of(0) on, with their covariance
  /// (including the lever arms' uncertainty) and their prior.
  Eigen::VectorXd constants;
  Eigen::MatrixXd constants_cov, constants_prior_cov;
  /// What the colour of the innovations and the hub's acceleration add to the passes' covariance.
  Eigen::MatrixXd constants_widened;
  WheelTrack track;
  Uncertain turns;
  double ekf_turns = 0.0;
  Consistency consistency;         ///< channels: along u and v of each sensor, without names
  std::vector<WheelDoubt> doubts;  ///< after the first second
  std::vector<TurnsCandidate> turns_candidates;  ///< if there are doubts
  /// Radius of each sensor from the recording alone, if one was given.
  std::vector<Uncertain> free_radius_m;
  std::optional<Uncertain> given_radius_m;  ///< the given radius, as far as it is trusted
  WheelSeries series;                       ///< output of filter and smoother, including time_s
};

/// Prior of the sensors' lever arms.
struct PlacesPrior {
  Eigen::VectorXd mean;  ///< (u, v) of each sensor, m
  Eigen::MatrixXd cov;   ///< m²
};

/// Above this standard deviation of the predicted angle, a turn may be lost.
inline constexpr double lost_prediction_rad = 0.8;

/// Extent of a fit.
enum class FitDepth {
  whole,
  /// Constants and track, without the smoothed motion: for a fit that is repeated with the radius.
  constants,
  /// The whole repetition, from the track of the first fit, in half the rounds.
  again,
  /// Motion and noise on averaged measurements, for a sensor that is then fitted together with
  /// another.
  track,
};

/// Estimates noise, lever arms and constants about the track, then smooths. With FitDepth::track,
/// the series is on the averages' time line and has only the smoother's own bands.
[[nodiscard]] WheelFit fit_wheel(WheelReadings& readings,
                                 WheelTrack track,
                                 const PlacesPrior& places_prior,
                                 FitDepth depth,
                                 const Progress& progress);

}  // namespace proofmass::estimate
