#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Bias against temperature: a curve that holds between the temperatures that were seen, and what
// judges it.
namespace proofmass::characterise {

struct TemperatureOptions {
  double rate_hz;
  /// Less than this and no curve is drawn: a chip warms itself by 1–2 K after power-up, while its
  /// thermometer and its sensing element differ by as much.
  double least_span_k = 2.0;
  int most_degree = 5;  ///< 1 … 8
};

enum class Sweep { dwell, heating, cooling };

/// Mean of the series about one temperature, for a figure.
struct TemperaturePoint {
  Sweep sweep = Sweep::dwell;
  double temperature_k = 0.0;
  double mean = 0.0;
  double std = 0.0;        ///< scatter of the block means in it; 0 of a single one
  std::size_t blocks = 0;  ///< block means behind it
};

/// How well a degree foretells what it was not fitted to.
struct DegreeScore {
  int degree = 0;
  double score = 0.0;   ///< mean square of the foretold blocks' errors, in that of the noise
  double excess = 0.0;  ///< over the best degree's score, fold by fold
  double std = 0.0;     ///< of the excess
};

/// Monic polynomials in x = (T − reference) / scale, orthogonal over the recording's temperatures:
///     p₀ = 1,     p₁ = x − α₀,     p_{j+1} = (x − α_j) p_j − β_j p_{j−1}
struct OrthogonalPolynomials {
  double reference_k = 0.0, scale_k = 1.0;
  std::vector<double> alpha, beta;  ///< as many as the highest degree; beta[0] is 0
  /// p₀ … of all degrees at a temperature.
  [[nodiscard]] Eigen::VectorXd at(double temperature_k) const;
};

/// What a recording says of its bias against temperature, in the unit u of the series. Where the
/// verdict is not identified the degree is 0 and the curve a level.
struct TemperatureModel {
  Verdict verdict = Verdict::not_observable;
  std::string reason;              ///< why it is not identified; empty where it is
  std::vector<std::string> notes;  ///< what to beware of, a sentence each

  double lowest_k = 0.0, highest_k = 0.0;  ///< the curve holds between these, not beyond
  double reference_k = 0.0;                ///< halfway
  int degree = 0;
  std::vector<Uncertain> coefficients;  ///< c_j of Σ c_j (T − reference)^j, u/K^j
  Eigen::MatrixXd covariance;           ///< of the coefficients
  OrthogonalPolynomials basis;
  Eigen::VectorXd basis_coefficients;  ///< u, of the basis: the form to compute with
  Eigen::MatrixXd basis_covariance;

  double bias_span = 0.0;  ///< largest less smallest of the curve, u
  /// Heating less cooling at the same temperature, u; none where one of the two is missing or they
  /// have less than a fifth of the range in common.
  std::optional<Uncertain> hysteresis;
  bool hysteresis_significant = false;  ///< beyond its 95 % interval about zero
  /// 95 % bound of the mean slope's size, u/K, from a straight line; none of a span too small.
  std::optional<double> slope_upper_95;

  std::vector<DegreeScore> cross_validation;  ///< by degree, ascending from 0
  double residual_std = 0.0;                  ///< of the block means about the curve
  double white_std = 0.0;                     ///< its part without memory
  double drift_std = 0.0;                     ///< its part that wanders, about its own mean
  double block_s = 0.0;
  std::vector<TemperaturePoint> points;

  /// The bias at a temperature. Errors: invalid_argument outside [lowest_k, highest_k].
  [[nodiscard]] Result<Uncertain> at(double temperature_k) const;
};

/// Fits bias against temperature to a series and the temperature beside it, both evenly sampled and
/// equally long, NaN missing.
///
/// Over up to 256 stretches of time, with the means of y and of each p_j(T) in a stretch:
///
///     y = Σ b_j p_j(T) + h d/2 + e,     d = +1 heating, −1 cooling, 0 dwelling
///
/// by generalised least squares, where e is white noise on a drift of any correlation time, both as
/// the residuals of the highest degree leave them likely. For the weights, not for the noise, the
/// white variance of a stretch is multiplied by the number of stretches whose temperature is within
/// a sixteenth of the range of its own (an eighth of even coverage at the least): an hour at one
/// temperature counts no more than the ramp. The covariance is that of these weights under the
/// noise found, so it holds for coloured residuals. The level is that of this recording: drift of
/// it as a whole is not in the std.
///
/// The degree is chosen by cross-validation in 8 folds, each of 4 contiguous stretches of time of
/// equal weight, foretold from all other blocks with the noise found: the lowest degree whose
/// excess over the best, paired by folds, is within one standard error. A leading term within its
/// own 95 % interval about zero is dropped then, and so on down.
///
/// Source: G. E. Forsythe, Generation and use of orthogonal polynomials for data-fitting with a
/// digital computer, J. SIAM 5 (1957) 74, the recurrence; C. R. Rao, Linear Statistical Inference
/// and Its Applications (1973), section 4a, least squares with correlated errors; L. Breiman, J.
/// Friedman, R. Olshen, C. Stone, Classification and Regression Trees (1984), section 3.4.3, the
/// rule of one standard error.
///
/// Errors: invalid_argument (options), too_few_samples (fewer than 32 stretches of 8 samples have
/// both). Cost: O(N most_degree), and some milliseconds.
[[nodiscard]] Result<TemperatureModel> fit_temperature(View<double> series,
                                                       View<double> temperature_k,
                                                       const TemperatureOptions& options);

}  // namespace proofmass::characterise
