#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// The tumble test: coefficients of the model equation from one accelerometer axis on a turntable.
namespace proofmass::calibrate {

/// Default standard deviation of the table's angle at each setting: set by hand to a scale of
/// degrees.
inline constexpr double assumed_indexing_std_rad = 0.5 * std::numbers::pi / 180.0;
/// Default standard deviation of the cosine and sine amplitudes of the bias drift about a straight
/// line, with the period of the test: ± 1 mg, rectangular (JCGM 100:2008, 4.3.7), the effect of 1 K
/// on an ADXL335 (1 mg/K, its data sheet).
inline constexpr double assumed_drift_std_mps2 = 1e-3 * 9.80665 / std::numbers::sqrt3;

struct TumbleOptions {
  double gravity_mps2;
  double gravity_std_mps2 = 0.0;
  /// Standard deviation of the table's angle at each setting; the error repeats at each visit of a
  /// setting. Absent: assumed_indexing_std_rad, or less if the residuals show it.
  std::optional<double> indexing_std_rad = {};
  /// Standard deviation of the amplitudes of the bias drift about a straight line during the test.
  /// Absent: assumed_drift_std_mps2 and a quarter of the linear drift, or less if the residuals
  /// show it.
  std::optional<double> drift_std_mps2 = {};
  /// Degrees of freedom of the positions' noise; 0: infinite.
  double noise_dof = 0.0;
  std::string output_unit = "m/s^2";  ///< unit of the outputs; for the coefficients' units
  /// Phase between the table's angle and the sensor's in each plane: see tumble/axes.hpp.
  std::array<double, 2> phase_rad{};
};

/// One coefficient, or the reason for its absence.
struct TumbleCoefficient {
  TumbleQuantity quantity = TumbleQuantity::K1;
  int plane = 0;           ///< of a coefficient specific to one plane; else 0
  double mount_rad = 0.0;  ///< of a misalignment
  std::optional<double> value;
  std::optional<double> std;            ///< absent if neither residuals nor noise determine it
  double dof = 0.0;                     ///< of std, for Student's t; 0: infinite
  std::optional<double> half_width_95;  ///< value ± this is a 95 % confidence interval
  std::string unit;                     ///< SI: "V/(m/s^2)"
  std::string meaning;                  ///< exact definition: "K0 + Kpp g²"
  std::string reason;                   ///< why value or std is absent
};

/// A part of the covariance, in the order of TumbleFit::coefficients.
struct TumbleShare {
  /// "scatter of the positions", "indexing of the table", "drift that is not straight", "gravity"
  std::string source;
  bool type_a = true;
  Eigen::MatrixXd covariance;
  double dof = 0.0;  ///< 0: infinite
};

/// Residual of one position.
struct TumbleResidual {
  double fitted = 0.0, residual = 0.0;  ///< unit of the output
  std::optional<double> std;            ///< expected standard deviation of the residual
  std::optional<double>
      studentised;       ///< by a fit to the other positions; absent without redundancy
  bool suspect = false;  ///< outlier; it stays in the fit
};

/// Test of the residuals against chance.
struct TumbleLackOfFit {
  std::string against;  ///< "noise of the means" or "repeated positions"
  double statistic = 0.0, p = 1.0;
  std::size_t dof = 0;     ///< of the lack of fit
  double noise_dof = 0.0;  ///< of the comparison; 0: infinite
};

/// Slow change of the bias during the test.
struct TumbleDrift {
  bool known = false;    ///< a position was revisited late enough
  bool in_time = false;  ///< per second; else per position
  bool removed = false;  ///< fitted with the coefficients; else it is part of the residuals
  std::optional<double> rate_mps2;  ///< per second or per position; see also TumbleQuantity::drift
  std::optional<double> p;          ///< p-value of the drift
  double nonlinear_std_mps2 = 0.0;  ///< assumed departure from the straight line
  bool nonlinear_assumed = false;   ///< a default was used
  std::string words;
};

/// Errors of the table's angle that repeat every turn.
struct TumbleIndexing {
  bool once_separated = false, twice_separated = false;
  double std_rad = 0.0;            ///< of the angle at each setting, as used
  bool assumed = false;            ///< a default was used
  std::vector<std::string> words;  ///< which terms are confounded, or the size of the errors
};

struct TumbleFit {
  std::vector<TumbleCoefficient> coefficients;  ///< the whole list, including those without a value
  Eigen::MatrixXd covariance;                   ///< of those, in their order; 0 without a value
  std::vector<TumbleShare> shares;              ///< their sum is the covariance
  /// For output = scale · f + bias, in the output's unit: bias is K1 (K0 + Kpp g²), or K1 (K0 + K2
  /// g²) if only that is determined.
  std::optional<double> bias_output, bias_output_std;
  std::vector<TumbleResidual> positions;  ///< in the order given
  double residual_rms = 0.0;              ///< √(Σ residual²/positions)
  std::optional<double> residual_std;     ///< √(Σ residual²/dof)
  std::size_t parameters = 0, dof = 0;    ///< fitted; positions minus parameters
  double scatter = 1.0;  ///< factor on the stated noise where the residuals exceed it (p < 0.01)
  bool noise_known = false;
  std::optional<TumbleLackOfFit> lack_of_fit;
  TumbleDrift drift;
  TumbleIndexing indexing;
  std::vector<std::string> notes;  ///< sentences for the user

  /// Ratio of the scale factor along the sensor's own axis to K1, its component along the nominal
  /// one: √(1 + δo² + δp²).
  [[nodiscard]] double own_axis_ratio() const;

  [[nodiscard]] const TumbleCoefficient* find(TumbleQuantity quantity, int plane = 0) const;
  /// Index of a coefficient in the list and the covariance.
  [[nodiscard]] std::optional<std::size_t> place_of(TumbleQuantity quantity, int plane = 0) const;
};

/// Fits, with φ = angle + mount + phase and ± for the direction of the last move,
///
///     E = U + S sin φ + T sin 3φ + Σ_planes [Q (1 + cos 2φ) + P sin 2φ + C3 cos 3φ]
///           + Σ_mountings D cos φ ± H/2 ± L/2 cos φ + R (t − t̄)
///           + cos φ (a₁ cos θ + b₁ sin θ + a₂ cos 2θ + b₂ sin 2θ)
///
/// by least squares, weighted if all positions state their noise.
///
/// - Terms, as far as the positions determine them: U, S, D, Q first; then those the test was
///   designed for (the bias per kelvin with temperatures, drift with a late revisit, hysteresis
///   with both directions, indexing with several mountings); then P, T, C3.
/// - A term is omitted if its column is not independent to 5 % or if no redundancy would remain
///   (three positions for C3, which is a test; none for the drift if noise is stated).
/// - The coefficients follow, K1 = (S + 3 T)/g and so on: tumble/model.hpp.
/// - cov = σ² (AᵀWA)⁻¹ + the shares of indexing, of nonlinear drift, and of gravity; σ² from the
///   residuals, minus what the others explain of them, or from the stated noise. For errors that
///   are assumed, not stated, see find_sizes().
///
/// Source: IEEE Std 1293-2018, the model equation, and 12.3.4 for static multipoint tumbling (by
/// its published description); GUM (JCGM 100:2008), 5 and G.4. Errors: too_few_samples (fewer than
/// two positions), not_observable (K1 is not determined), not_finite, invalid_argument. Cost:
/// O(positions · parameters²).
[[nodiscard]] Result<TumbleFit> fit_tumble(View<TumblePosition> positions,
                                           const TumbleOptions& options);

}  // namespace proofmass::calibrate
