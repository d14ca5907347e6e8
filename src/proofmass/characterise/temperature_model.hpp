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

// Bias against temperature: a curve valid in the observed temperature range, and its diagnostics.
namespace proofmass::characterise {

struct TemperatureOptions {
  double rate_hz;
  /// Minimum temperature range for a curve: a chip heats itself by 1–2 K after power-up, and its
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
  double std = 0.0;        ///< scatter of its block means; 0 for a single one
  std::size_t blocks = 0;  ///< number of block means
};

/// Prediction error of a polynomial degree on held-out data.
struct DegreeScore {
  int degree = 0;
  /// Mean square prediction error of the held-out blocks, relative to the noise.
  double score = 0.0;
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

/// Fitted dependence of the bias on temperature, in the unit u of the series. If not identified,
/// the degree is 0 and the curve a constant.
struct TemperatureModel {
  Verdict verdict = Verdict::not_observable;
  std::string reason;              ///< why it is not identified; empty if it is
  std::vector<std::string> notes;  ///< warnings, a sentence each

  double lowest_k = 0.0, highest_k = 0.0;  ///< range of validity of the curve
  double reference_k = 0.0;                ///< halfway
  int degree = 0;
  std::vector<Uncertain> coefficients;  ///< c_j of Σ c_j (T − reference)^j, u/K^j
  Eigen::MatrixXd covariance;           ///< of the coefficients
  OrthogonalPolynomials basis;
  Eigen::VectorXd basis_coefficients;  ///< u, of the basis: the numerically stable form
  Eigen::MatrixXd basis_covariance;

  double bias_span = 0.0;  ///< range of the curve, u
  /// Heating minus cooling at the same temperature, u; absent if one of the two is missing or they
  /// share less than a fifth of the range.
  std::optional<Uncertain> hysteresis;
  bool hysteresis_significant = false;  ///< its 95 % interval excludes zero
  /// 95 % upper limit of the mean slope's magnitude, u/K, from a straight line; absent if the range
  /// is too small.
  std::optional<double> slope_upper_95;

  std::vector<DegreeScore> cross_validation;  ///< by degree, ascending from 0
  double residual_std = 0.0;                  ///< of the block means about the curve
  double white_std = 0.0;                     ///< its white part
  double drift_std = 0.0;                     ///< its drift part, about its own mean
  double block_s = 0.0;
  std::vector<TemperaturePoint> points;

  /// The bias at a temperature. Errors: invalid_argument outside [lowest_k, highest_k].
  [[nodiscard]] Result<Uncertain> at(double temperature_k) const;
};

/// Fits bias against temperature to a series and the simultaneous temperature, both evenly sampled
/// and equally long, NaN missing.
///
/// Over up to 256 intervals of time, with the means of y and of each p_j(T) in an interval:
///
///     y = Σ b_j p_j(T) + h d/2 + e,     d = +1 heating, −1 cooling, 0 dwelling
///
/// by generalised least squares.
///
/// - Noise: e is white noise plus drift of any correlation time, both estimated from the residuals
///   of the highest degree.
/// - Weights: the white variance of an interval is multiplied by the number of intervals whose
///   temperature is within a sixteenth of the range of its own (an eighth of even coverage at the
///   least), so that an hour at one temperature counts no more than the ramp. The covariance is
///   that of these weights under the estimated noise, so it holds for coloured residuals.
/// - The level is that of this recording: a drift of it as a whole is not in the std.
/// - The degree is chosen by cross-validation in 8 folds, each of 4 contiguous intervals of time of
///   equal weight, predicted from all other blocks with the estimated noise: the lowest degree
///   whose excess over the best, paired by folds, is within one standard error. A leading term
///   within its own 95 % interval about zero is then dropped, and so on down.
///
/// Source: G. E. Forsythe, Generation and use of orthogonal polynomials for data-fitting with a
/// digital computer, J. SIAM 5 (1957) 74, the recurrence; C. R. Rao, Linear Statistical Inference
/// and Its Applications (1973), section 4a, least squares with correlated errors; L. Breiman, J.
/// Friedman, R. Olshen, C. Stone, Classification and Regression Trees (1984), section 3.4.3, the
/// rule of one standard error.
///
/// Errors: invalid_argument (options), too_few_samples (fewer than 32 intervals of 8 samples have
/// both). Cost: O(N most_degree), and some milliseconds.
[[nodiscard]] Result<TemperatureModel> fit_temperature(View<double> series,
                                                       View<double> temperature_k,
                                                       const TemperatureOptions& options);

}  // namespace proofmass::characterise
