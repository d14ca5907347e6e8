#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/signal/encoder.hpp"

// Eccentricity and missed counts of an encoder on a wheel, with the accelerometers on the wheel as
// the reference.
namespace proofmass::calibrate {

/// Accelerometers and encoder of a wheel on one clock.
struct EncoderRecording {
  std::string name;
  std::vector<double> time_s;             ///< of the accelerometers, increasing
  std::vector<std::vector<double>> axes;  ///< m/s², as long as time_s; NaN where missing
  std::vector<std::string> axis_names;
  std::vector<std::size_t> sensor_of;  ///< of each axis; axes of one sensor share a lever arm
  signal::AngleFixes encoder;          ///< angle as the encoder shows it
  double step_rad = 0.0;  ///< one count; 0: no visible steps, and no search for missed counts
  /// Slips that the index pulse shows, removed already.
  std::vector<signal::CountSlip> index_slips = {};
  bool has_index = false;  ///< angle 0 is at the index pulse
};

/// Standard deviations of what the recording may not show.
struct EncoderOptions {
  double gravity_mps2 = standard_gravity_mps2;
  /// Departure of an accelerometer from a straight line at 1 g, relative to 1 g, of second and of
  /// third order.
  double nonlinearity = 2e-4;
  double runout_m = 30e-6;  ///< run-out of the axle, once a turn
  double radius_m = 0.3;    ///< distance of the accelerometers from the axle
  double delay_s = 0.01;    ///< of the accelerometers after the encoder
};

/// Orders that are fitted. Those above the second are there because they resemble the first two.
inline constexpr std::size_t encoder_orders = 4;
inline constexpr std::size_t encoder_parameters = 2 * encoder_orders;

/// The encoder's error of one order, amplitude · cos(n θ + phase) = c cos nθ + s sin nθ.
struct EncoderHarmonic {
  int per_turn = 1;
  Uncertain cos_rad{}, sin_rad{};
  double half_width_95_rad = 0.0;  ///< of c and s, the larger
  double chance_p = 1.0;           ///< probability of such values without an error of this order
  std::optional<Uncertain> amplitude_rad;  ///< absent unless chance_p < 0.01
  std::array<double, 2> amplitude_95_rad{};
  std::optional<Uncertain> phase_rad;
  std::optional<std::array<double, 2>> phase_95_rad;
};

/// Contribution to the standard deviation of the first two orders' components, rms of c and s.
struct EncoderShare {
  std::string source;
  bool type_a = false;
  std::array<double, 2> std_rad{};
};

struct EncoderCalibration {
  std::array<EncoderHarmonic, encoder_orders> harmonics{};
  /// Covariance of c1 s1 c2 s2 for use with another recording.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::vector<EncoderShare> shares;
  double step_rad = 0.0;
  std::vector<signal::CountSlip> missed;  ///< by the accelerometers
  std::optional<int> detectable_counts;   ///< the fewest that would have been found
  Uncertain delay_s{};                    ///< of the accelerometers after the encoder
  std::vector<double> residual_rms_mps2;  ///< of each axis used
  std::vector<std::string> axis_names;    ///< of those
  double turns = 0.0;                     ///< sum over both directions
  double speed_min_radps = 0.0, speed_max_radps = 0.0;
  std::size_t samples = 0, blocks = 0;
  double dof = 0.0;  ///< of type A, for Student's t
  int iterations = 0;
  bool converged = false;
  double nonlinearity = 0.0;  ///< as used: the option, or more if the residuals show more
  /// For plots: offset of the encoder from gravity's direction, with the errors fitted and without,
  /// against time and the wheel's angle.
  std::vector<double> offset_time_s, offset_angle_rad, offset_rad, fitted_rad;
  std::vector<Note> notes;
};

/// Fits
///
///     ψ = θ + Σ c_n cos nθ + s_n sin nθ,   n = 1 … 4,
///     z = b(t) + p ((1 + y) sin θ' + x cos θ' − (ω² r_x + α r_y)/g)
///              + q ((1 + y) cos θ' − x sin θ' − (ω² r_y − α r_x)/g)
///              + k₂ cos 2θ + k₂' sin 2θ + k₃ cos 3θ + k₃' sin 3θ,
///
/// with the encoder's angle ψ, θ' = θ − τ ω, for each accelerometer its lever arm r, and for each
/// of its axes a bias b (a cubic of the time), the response p, q to gravity in the plane (scale,
/// skew and mounting) and nonlinearity k. x and y are the acceleration of the axle by its run-out,
/// ω²/g times (h₁ cos θ + h₂ sin θ) and (h₃ cos θ + h₄ sin θ).
///
/// - A bias displaces the circle on which gravity moves and an eccentricity does not, so that they
///   are separable: the eccentricity appears at twice a turn in the accelerometer's axes, the
///   second order at three times. What else appears there is the accelerometer's nonlinearity, the
///   run-out (∝ ω²) and, through the lever arm, the speed: these are parameters with a prior, and
///   the intervals contain what the recording does not separate.
/// - Type A: scatter of the gradient between blocks of whole turns, cov = H⁻¹ (M + P) H⁻¹ with the
///   precision P of the priors, for noise of any colour within a block; Student's t.
/// - Missed counts: steps of whole counts of ψ less the fitted θ (signal::find_count_slips()); they
///   are removed, and the fit repeated.
///
/// Source: kinematics of a rigid body in a plane; for the covariance H. White, Econometrica 48
/// (1980) 817; eccentricity of a disc once a turn, and of its warping twice:
/// docs/methods/encoder.md.
///
/// Errors: invalid_argument (unequal lengths, no axis), too_few_samples (under 5 turns, or an
/// encoder with fewer than 48 fixes a turn), not_observable (no axis follows gravity).
[[nodiscard]] Result<EncoderCalibration> calibrate_encoder(const EncoderRecording& recording,
                                                           const EncoderOptions& options = {});

}  // namespace proofmass::calibrate
