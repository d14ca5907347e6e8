#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/sensor/model_equation.hpp"

// Coefficients of the full model equation from measurements under known motion.
namespace proofmass::calibrate {

/// One measurement of the output under known motion.
struct ModelRow {
  sensor::Motion motion;
  double output = 0.0;
  double output_std = 0.0;  ///< of the measurement, in its unit; 0 if unknown
};

struct ModelFitOptions {
  std::vector<sensor::Coefficient> fitted;  ///< each once; K1 should be among them
  sensor::ModelEquation held;               ///< values of the others
};

/// One requested coefficient.
struct FittedCoefficient {
  sensor::Coefficient coefficient = sensor::Coefficient::K0;
  std::optional<Uncertain> value = {};  ///< in the unit of sensor::info()
  double half_width_95 = 0.0;           ///< value ± this is a 95 % confidence interval
  /// Variance inflation factor: variance over its value with all other coefficients known; 0
  /// without a value.
  double variance_inflation = 0.0;
  std::string reason = {};  ///< a sentence, if there is no value
};

/// A sum of coefficients that the rows determine although they do not determine its parts.
struct Combination {
  std::string name;                                           ///< "K2 − Kpp"
  std::vector<std::pair<sensor::Coefficient, double>> parts;  ///< value = Σ factor · coefficient
  Uncertain value;                                            ///< in the unit of the first part
};

/// Coefficients whose terms are linearly dependent in every row.
struct Confounded {
  std::vector<sensor::Coefficient> coefficients;
  std::size_t determined = 0;          ///< number that could be determined if the others were known
  std::vector<std::string> relations;  ///< relations between the terms: "a_p² = 1 g² − a_i²"
  std::vector<Combination> combinations;
  std::string words;  ///< a sentence or two: which are confounded, why, and the remedy
};

/// Test whether the stated standard deviation of the measurements explains the residuals.
struct ResidualTest {
  double chi_square = 0.0;  ///< Σ (residual/std)²
  double p = 1.0;           ///< p-value
};

struct ModelFit {
  sensor::ModelEquation equation;               ///< held values where nothing was determined
  std::vector<FittedCoefficient> coefficients;  ///< in the order requested
  Eigen::MatrixXd covariance;                   ///< of those, in their order; zero without a value
  std::vector<Confounded> confounded;
  std::vector<double> residuals;      ///< of the rows, in the output's unit
  std::vector<std::size_t> suspects;  ///< outlying rows; they stay in the fit
  double residual_rms = 0.0;          ///< √(Σ residual²/rows)
  std::size_t dof = 0;                ///< rows minus determined coefficients and combinations
  std::optional<ResidualTest> test;   ///< absent without stated standard deviations or with dof 0
  double scatter = 1.0;               ///< factor on the stated standard deviations, see below
  double condition = 0.0;             ///< condition number of the design, columns of unit length
  /// Uncertainties come from the rows' standard deviations, not the residuals.
  bool std_stated = false;
  std::vector<std::string> notes;  ///< sentences for the user

  [[nodiscard]] const FittedCoefficient* find(sensor::Coefficient coefficient) const;
};

/// Weighted least squares in the products β = K1 · coefficient, in which the equation is linear,
///
///     E − K1 (held terms) = K1 a_i + Σ β_k t_k,     c_k = β_k / K1,
///     cov c = J cov β Jᵀ,   ∂c_k/∂β_k = 1/K1,   ∂c_k/∂K1 = −c_k/K1.
///
/// - Covariance: if the rows state standard deviations, from these, widened by √(χ²/dof) if the
///   residuals exceed them significantly (p < 0.01); otherwise from s² = Σ residual²/dof, and
///   intervals need Student's t with dof.
/// - A row is suspect if its residual against a fit to the others is significant at 1 % over all
///   rows (Bonferroni): against the stated standard deviation if that explains the other rows, else
///   by Student's t with dof − 1. Source: R. D. Cook, S. Weisberg, Residuals and Influence in
///   Regression (1982), 2.2.
/// - Terms that the rows do not excite, and groups of terms that are linearly dependent in all rows
///   to within one part in ten thousand (motion is seldom known better), have reasons instead of
///   values. The determinable combinations of such a group are among the combinations. If K1 itself
///   is in such a group, the other coefficients are relative to the combination that replaces it.
///
/// Source: S. Weisberg, Applied Linear Regression, 3rd ed. (2005), sections 5.1 and 10.1; D. A.
/// Belsley, E. Kuh, R. E. Welsch, Regression Diagnostics (1980), chapter 3.
///
/// Errors: too_few_samples (fewer rows than coefficients; no redundancy and no stated standard
/// deviation), not_finite, invalid_argument (none requested, one requested twice, a standard
/// deviation below zero or stated for part of the rows only), not_observable (K1 is fitted and the
/// rows do not excite it, or it is not distinguishable from zero). Cost: O(rows · coefficients²).
[[nodiscard]] Result<ModelFit> fit_model_equation(View<ModelRow> rows,
                                                  const ModelFitOptions& options);

}  // namespace proofmass::calibrate
