#pragma once

#include <array>
#include <optional>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/estimate/wheel_model.hpp"

// From planar measurements to the wheel's angle: where the motion starts, what the noise is, where
// the sensors sit and what their constants are, then the smoother. The steps behind
// estimate_wheel().
namespace proofmass::estimate {

/// The measurements of one or two sensors on one time line.
struct WheelReadings {
  double gravity_mps2 = standard_gravity_mps2;  ///< its component in the plane of the wheel
  double gravity_std_mps2 = 0.0;                ///< of that, for want of knowing the axle's tilt
  std::optional<double> given_rolling_radius_m;
  Uncertain rolling_radius_m{};  ///< as assume_rolling_radius() sets it
  Uncertain delay_s{};           ///< of the sensors' filters
  double phase_rad = 0.0;        ///< of the second sensor against the first, as known so far
  RippleOrders orders = first_orders;
  /// The hub vibrates by more than a sensor's noise, or more in motion than at rest, as under a
  /// vehicle; set by settle_variance().
  bool shakes = false;
  std::vector<double> time_s;
  std::vector<WheelInstant> instants;
  std::vector<PlanarReadings> sensors;

  /// 1 / mean step, without gaps; 0 if there is no step.
  [[nodiscard]] double rate_hz() const;
};

/// The measurements averaged over `each` epochs at a time: as good as all of them where the wheel
/// turns little within, at a fraction of the cost.
[[nodiscard]] WheelReadings averaged(const WheelReadings& readings, std::size_t each);

/// One standard deviation, about zero, of what is believed of a sensor before the recording speaks.
struct ConstantsPrior {
  double bias_mps2 = 0.5, scale = 0.1, skew_rad = 0.03, phase_rad = 0.5, place_m = 0.3;
  double ripple = 0.0;  ///< of each part, share of the speed
  double gyro_bias_radps = 0.1, gyro_scale = 0.03;
};

/// The same for a wheel that turns less than once: gravity shows no more than a piece of its
/// circle, on which bias, scale and angle stand for each other, so more has to be believed.
inline constexpr ConstantsPrior short_way_prior{0.2, 0.01, 0.01, 0.5, 0.1};

/// What the wheel rolls on, by how it shakes, where that is not given: that of a vehicle between 0
/// and 0.4 m, each as likely; else a bench's 0, to what something small and smooth may have.
void assume_rolling_radius(WheelReadings& readings);

/// How the motion begins, for a filter that has seen nothing yet.
struct Beginning {
  double angle_rad = 0.0, angle_std_rad = 0.6;
  double speed_radps = 0.0, speed_std_radps = 1.0;
};

/// A trajectory found so far, and what it was found with.
struct WheelTrack {
  Beginning beginning;
  WheelNoise noise;
  WheelPath path;
  double lost = 1.0;  ///< share of the measurements that it does not explain, 0 … 1
};

/// Eight measurements a turn: no faster wheel is looked for, nor believed.
[[nodiscard]] constexpr double fastest_radps(double rate_hz) {
  return rate_hz * rad_per_turn / 8.0;
}

/// Follows a single sensor's phase through the recording with whatever noise figures keep it: from
/// a grid of starting speeds and angles, since at speed and off the axle the first measurements do
/// not show where gravity is. Sets the measurements' variance on the way. `first` of wheel_seeks
/// sets of noise figures are passed over, where they have led astray.
[[nodiscard]] WheelTrack find_track(WheelReadings& readings, std::size_t first = 0);
inline constexpr std::size_t wheel_seeks = 4;

/// A stretch over which the angle is predicted to no better than lost_prediction_rad: epochs, the
/// first and the last that are predicted so badly.
struct WheelDoubt {
  std::size_t first = 0, last = 0;
  std::size_t widest = 0;               ///< where the prediction is least certain
  Gaussian<wheel::moving> predicted{};  ///< that prediction, of the moving states
};

struct WheelFit {
  /// All that stands, in the state's order from wheel::first_of(0) on, with its covariance (the
  /// places' uncertainty in it) and what that was before the recording spoke.
  Eigen::VectorXd constants;
  Eigen::MatrixXd constants_cov, constants_prior_cov;
  WheelTrack track;
  Uncertain turns;
  double ekf_turns = 0.0;
  Consistency consistency;         ///< channels: along u and v of each sensor, without names
  std::vector<WheelDoubt> doubts;  ///< once past the first second
  std::vector<TurnsCandidate> turns_candidates;  ///< where there are doubts
  /// Of each sensor, where a radius was given: what the recording alone says of it.
  std::vector<Uncertain> free_radius_m;
  std::optional<Uncertain> given_radius_m;  ///< the radius that was given, as far as it is trusted
  WheelSeries series;                       ///< what filter and smoother give; time_s too
};

/// What is known of the sensors' lever arms beforehand.
struct PlacesPrior {
  Eigen::VectorXd mean;  ///< (u, v) of each sensor, m
  Eigen::MatrixXd cov;   ///< m²
};

/// The angle is anybody's guess where its prediction is less sure than this: a turn may be lost.
inline constexpr double lost_prediction_rad = 0.8;

/// How far a fit goes.
enum class FitDepth {
  whole,
  /// Motion and noise on averaged measurements, for a sensor whose fit with another follows.
  track,
};

/// Settles noise, places and constants about the track, then smooths. A fit to FitDepth::track has
/// series on the averages' time line, and no more bands than the smoother's own.
[[nodiscard]] WheelFit fit_wheel(WheelReadings& readings,
                                 WheelTrack track,
                                 const PlacesPrior& places_prior,
                                 FitDepth depth,
                                 const Progress& progress);

}  // namespace proofmass::estimate
