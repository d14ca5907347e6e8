#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Bias, scale factor and the other tumble coefficients, from a sensor on a wheel that rotates
// steadily about a fixed horizontal axle.
namespace proofmass::calibrate {

/// One recording: one axis in the plane of the wheel, or two orthogonal ones.
struct RotationRecording {
  std::string name;
  std::vector<double> time_s;
  std::vector<std::vector<double>> axes;  ///< output of each axis; NaN where missing
  std::vector<double> angle_rad;          ///< of an encoder, unwrapped or wrapped; empty: unknown
};

struct RotationOptions {
  double gravity_mps2;
  double gravity_std_mps2 = 0.0;
  bool readings_are_accelerations = false;  ///< so K1 should be about 1
  double turns_per_knot = 4.0;              ///< of the phase spline, without an encoder; at least 3
  double bandwidth_hz = 0.0;                ///< of the sensor's one-pole filter; 0: not stated
};

/// Standard deviation of each component of the sensor's distance from the axle, if one speed does
/// not determine it.
inline constexpr double assumed_radius_std_m = 0.1;
/// Standard deviation of the delay of the sensor's filter if neither its bandwidth is stated nor
/// the speeds determine it: one pole at 16 Hz.
inline constexpr double assumed_delay_std_s = 0.01;

// NOLINTBEGIN(readability-identifier-naming): these are the standard's names.
enum class RotationQuantity {
  K1,            ///< (S1 + 3 S3)/g
  K0,            ///< K0 + Kpp g² = (B0 + C2)/K1: the bias at 0 g
  K0_radial,     ///< K0 + Kpp g² − r ω² at the mean of ω²: observable at one speed
  misalignment,  ///< C1/(K1 g)
  K2_minus_Kpp,  ///< −2 C2/(K1 g²)
  Kip,           ///< 2 S2/(K1 g²)
  K3,            ///< −4 S3/(K1 g³)
  radius,        ///< along the axis: the output falls by K1 r ω²
};
// NOLINTEND(readability-identifier-naming)
inline constexpr std::size_t rotation_quantities = 8;

/// "K2_minus_Kpp": the name used in documents.
[[nodiscard]] std::string_view name_of(RotationQuantity quantity);

struct RotationCoefficient {
  RotationQuantity quantity = RotationQuantity::K1;
  std::optional<Uncertain> value = {};
  double half_width_95 = 0.0;  ///< value ± this is a 95 % confidence interval
  std::string reason = {};     ///< a sentence, if there is no value
};

/// Output of one axis folded over the turns.
struct RotationFold {
  std::vector<double> angle_rad;     ///< middle of each bin, 0 … 2π of the axis's own phase
  std::vector<double> mean;          ///< output, in its unit
  std::vector<double> residual;      ///< mean residual
  std::vector<double> residual_std;  ///< of that mean, assuming white noise
};

struct RotationAxis {
  std::array<RotationCoefficient, rotation_quantities> coefficients;
  /// B0, S1, C1, S2, C2, S3, C3 and the ω² term: unit of the output.
  std::array<double, 8> harmonics{};
  double residual_rms = 0.0;
  RotationFold fold;
  std::optional<Uncertain> delay_s;  ///< of the output after the encoder's angle

  [[nodiscard]] const RotationCoefficient& operator[](RotationQuantity quantity) const {
    return coefficients[static_cast<std::size_t>(quantity)];
  }
};

/// Angle-dependent speed, if two axes determine it: Δω/ω = Σ amplitude cos(n φ + …).
struct SpeedRipple {
  int per_turn = 1;
  std::optional<Uncertain> amplitude = {};  ///< relative; absent if not significant
  double chance_p = 1.0;  ///< p-value of the hypothesis of no ripple and no nonlinearity
  bool accepted = false;  ///< the harmonics are attributed to it, not to the sensor
};

/// Change of the coefficients by a ripple of 1 % attributed to the sensor.
struct RippleEffect {
  double bias_mps2, second_order_s2pm;                         ///< once a turn
  double scale_relative, misalignment_rad, third_order_s4pm2;  ///< twice a turn
};

/// An interval of steady rotation.
struct RotationSection {
  std::size_t recording = 0;
  double start_s = 0.0, end_s = 0.0;
  double turns = 0.0;
  double speed_radps = 0.0;         ///< mean
  double speed_spread_radps = 0.0;  ///< rms of its slow variation
};

struct RotationFit {
  std::vector<RotationAxis> axes;
  std::vector<RotationSection> sections;
  bool angle_given = false;
  std::optional<int> direction;  ///< +1: the second axis leads by a quarter turn; two axes only
  /// Distance from the axle in the plane of the axes: with two axes, √(r_1² + r_2²).
  RotationCoefficient radius{.quantity = RotationQuantity::radius};
  std::vector<SpeedRipple> ripples;  ///< once to five times a turn; without an encoder
  RippleEffect per_percent{};        ///< of ripple
  double turns = 0.0;                ///< number used
  double steady_fraction = 0.0;      ///< of the recorded time
  std::size_t samples = 0;           ///< number used
  std::size_t blocks = 0;            ///< number whose scatter gives the standard deviations
  double dof = 0.0;                  ///< of the standard deviations, for Student's t
  int iterations = 0;
  bool converged = false;
  std::vector<std::string> notes;  ///< sentences for the user
  /// Reasons why this may not be a bench test: more severe than notes.
  std::vector<std::string> doubts;
};

/// The axes in the plane of rotation: the one with the largest gravity amplitude, and another with
/// at least half of it. In their order.
[[nodiscard]] std::vector<std::size_t> axes_in_plane(View<View<double>> readings);

/// Fits all recordings together, with φ the phase of each axis (the second a quarter turn ahead),
///
///     E = B0 + S1 sin φ + C1 cos φ + S2 sin 2φ + C2 cos 2φ + S3 sin 3φ + C3 cos 3φ − A ω²,
///
/// by Gauss–Newton.
///
/// - Without an encoder, φ(t) is a cubic spline with knots several turns apart, so that it follows
///   slow changes of speed but nothing within a turn, and the first axis's C1 is zero by
///   definition. In addition a ripple of one to five times a turn is fitted in each section; its
///   possible confusion with the sensor's own terms is included in the intervals, see RippleSplit.
/// - With an encoder, a delay τ of the sensor shifts the phase by −τ φ̇: fitted if the speed varies,
///   else included in the interval of the misalignment.
/// - Coefficients follow as in RotationQuantity, by the delta method; standard deviations are
///   half-widths of the 95 % intervals over 1.96.
///
/// Standard deviations come from the scatter of the fit's gradient between blocks of whole turns
/// (up to 24, at least 4 turns if there are enough),
///
///     var = Σ_s B_s/(B_s − 1) Σ_b z_b²,   z_b = gradient · H⁻¹ g_b, B_s blocks of section s,
///
/// with Welch's degrees of freedom, and so hold for noise of any colour whose correlation time is
/// shorter than a block; K0 and radius, which depend on the mean output, use blocks up to three
/// times as long. If neighbouring blocks are significantly correlated, standard deviations are
/// widened and a note reports it.
///
/// Only intervals of at least 8 turns count in which no turn's duration differs from its
/// neighbours' by more than 8 %: elsewhere r ω̇ would not be negligible.
///
/// Source: model equation of IEEE Std 1293-2018; C. de Boor, A Practical Guide to Splines (2001),
/// chapter 9; for the covariance H. White, Econometrica 48 (1980) 817, and P. Flyvbjerg, H. G.
/// Petersen, J. Chem. Phys. 91 (1989) 461.
///
/// Errors: invalid_argument (no recording, no axis or more than two, unequal lengths, an angle in
/// part of the recordings only), not_finite, too_few_samples (fewer than 12 steady turns, or fewer
/// than 16 samples a turn), not_observable (output that does not follow gravity once a turn). Cost:
/// O(samples) a pass, some ten passes, and O(knots³).
[[nodiscard]] Result<RotationFit> fit_rotation(View<RotationRecording> recordings,
                                               const RotationOptions& options);

}  // namespace proofmass::calibrate
