#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble_model.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// The tumble test: coefficients of the model equation from one accelerometer axis on a turntable.
namespace proofmass::calibrate {

/// Standard deviation of the table's angle at each setting where nothing is stated of it: set by
/// hand to a scale of degrees.
inline constexpr double assumed_indexing_std_rad = 0.5 * std::numbers::pi / 180.0;
/// Of the amplitudes, cosine and sine, of the bias's wander about a straight line with the period
/// of the test, where nothing is stated of it: ± 1 mg, rectangular
/// (JCGM 100:2008, 4.3.7), what 1 K makes of an ADXL335 (1 mg/K, its data sheet).
inline constexpr double assumed_drift_std_mps2 = 1e-3 * 9.80665 / std::numbers::sqrt3;

struct TumbleOptions {
  double gravity_mps2;
  double gravity_std_mps2 = 0.0;
  /// Of the table's angle at each setting, the same error at each visit of one setting. Absent:
  /// assumed_indexing_std_rad, or less where the residuals show it.
  std::optional<double> indexing_std_rad = {};
  /// Of the amplitudes of the bias's wander about a straight line during the test. Absent:
  /// assumed_drift_std_mps2 and a quarter of the linear drift, or less where the residuals show it.
  std::optional<double> drift_std_mps2 = {};
  /// How well the positions' noise is known; 0: for certain.
  double noise_dof = 0.0;
  std::string output_unit = "m/s^2";  ///< in which the outputs are; for the coefficients' units
  /// What stands between the table's angle and the sensor's in each plane: see tumble_axes.hpp.
  std::array<double, 2> phase_rad{};
};

/// One coefficient, or why there is none.
struct TumbleCoefficient {
  TumbleQuantity quantity = TumbleQuantity::K1;
  int plane = 0;           ///< of what is a plane's own; else 0
  double mount_rad = 0.0;  ///< of a misalignment
  std::optional<double> value;
  std::optional<double> std;            ///< absent where neither residuals nor noise can tell
  double dof = 0.0;                     ///< of std, for Student's t; 0: infinitely many
  std::optional<double> half_width_95;  ///< value ± this holds the truth in 95 % of tests
  std::string unit;                     ///< SI: "V/(m/s^2)"
  std::string meaning;                  ///< what it is exactly: "K0 + Kpp g²"
  std::string reason;                   ///< why value or std is absent
};

/// A part of the covariance, in the order of TumbleFit::coefficients.
struct TumbleShare {
  /// "scatter of the positions", "indexing of the table", "drift that is not straight", "gravity"
  std::string source;
  bool type_a = true;
  Eigen::MatrixXd covariance;
  double dof = 0.0;  ///< 0: infinitely many
};

/// One position against the fit.
struct TumbleResidual {
  double fitted = 0.0, residual = 0.0;  ///< unit of the output
  std::optional<double> std;            ///< of the residual, as the fit expects it
  std::optional<double>
      studentised;       ///< by a fit to the other positions; absent without any to spare
  bool suspect = false;  ///< it contradicts the others; it stays in the fit
};

/// Do the residuals look like chance?
struct TumbleLackOfFit {
  std::string against;  ///< "noise of the means" or "repeated positions"
  double statistic = 0.0, p = 1.0;
  std::size_t dof = 0;     ///< of the lack of fit
  double noise_dof = 0.0;  ///< of what it is compared with; 0: infinitely many
};

/// The slow change of the bias while the positions were read.
struct TumbleDrift {
  bool known = false;    ///< a position was visited again late enough
  bool in_time = false;  ///< per second; else per position
  bool removed = false;  ///< fitted with the coefficients; else it is part of the residuals
  std::optional<double> rate_mps2;  ///< per second or per position; TumbleQuantity::drift has more
  std::optional<double> p;          ///< of so much drift or more by chance
  double wander_std_mps2 = 0.0;     ///< allowed for about the straight line
  bool wander_assumed = false;      ///< nothing was stated of it
  std::string words;
};

/// Errors of the table's angle that come again every turn.
struct TumbleIndexing {
  bool once_separated = false, twice_separated = false;
  double std_rad = 0.0;            ///< of the angle at each setting, as used
  bool assumed = false;            ///< nothing was stated of it
  std::vector<std::string> words;  ///< what is confounded with what, or how large it is
};

struct TumbleFit {
  std::vector<TumbleCoefficient> coefficients;  ///< the whole list, also those without a value
  Eigen::MatrixXd covariance;                   ///< of those, in their order; 0 where there is none
  std::vector<TumbleShare> shares;              ///< their sum is the covariance
  /// Of readings = scale · f + bias, in the unit of the output: bias is K1 (K0 + Kpp g²), or
  /// K1 (K0 + K2 g²) where that alone is determined.
  std::optional<double> bias_output, bias_output_std;
  std::vector<TumbleResidual> positions;  ///< in the order given
  double residual_rms = 0.0;              ///< √(Σ residual²/positions)
  std::optional<double> residual_std;     ///< √(Σ residual²/dof)
  std::size_t parameters = 0, dof = 0;    ///< fitted; positions less parameters
  double scatter = 1.0;  ///< factor on the stated noise where the residuals exceed it (p < 0.01)
  bool noise_known = false;
  std::optional<TumbleLackOfFit> lack_of_fit;
  TumbleDrift drift;
  TumbleIndexing indexing;
  std::vector<std::string> notes;  ///< sentences for the user

  [[nodiscard]] const TumbleCoefficient* find(TumbleQuantity quantity, int plane = 0) const;
  /// The place of a coefficient in the list and the covariance.
  [[nodiscard]] std::optional<std::size_t> place_of(TumbleQuantity quantity, int plane = 0) const;
};

/// Fits, with φ = angle + mount + phase and ± for the direction of the last move,
///
///     E = U + S sin φ + T sin 3φ + Σ_planes [Q (1 + cos 2φ) + P sin 2φ + C3 cos 3φ]
///           + Σ_mountings D cos φ ± H/2 ± L/2 cos φ + R (t − t̄)
///           + cos φ (a₁ cos θ + b₁ sin θ + a₂ cos 2θ + b₂ sin 2θ)
///
/// by least squares, weighted where all positions state their noise, as far as the positions carry
/// it: U, S, D, Q first, then what the test was laid out for (the bias per kelvin where
/// temperatures are given, drift where a position is visited again late, hysteresis where there are
/// both directions, indexing where the sensor was mounted anew), then P, T, C3. A term is left out
/// where its column is not its own to 5 % or where no position would be over to judge by (three
/// beside C3, which is a test; none beside the drift where noise is stated). The coefficients
/// follow, K1 = (S + 3 T)/g and so on: tumble_model.hpp. cov = σ² (AᵀWA)⁻¹ + the shares of
/// indexing, of drift that is not straight, and of gravity; σ² from the residuals, less what the
/// others explain of them, or from the stated noise. Of errors that are assumed, not stated, see
/// find_sizes().
///
/// Source: IEEE Std 1293-2018, the model equation, and 12.3.4 for static multipoint tumbling (by
/// its published description); GUM (JCGM 100:2008), 5 and G.4.
/// Errors: too_few_samples (fewer than two positions), not_observable (K1 cannot be told),
/// not_finite, invalid_argument. Cost: O(positions · parameters²).
[[nodiscard]] Result<TumbleFit> fit_tumble(View<TumblePosition> positions,
                                           const TumbleOptions& options);

}  // namespace proofmass::calibrate
