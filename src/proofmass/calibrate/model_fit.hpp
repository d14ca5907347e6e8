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

// Coefficients of the full model equation from readings under known motion.
namespace proofmass::calibrate {

/// One reading of the output while the motion was known.
struct ModelRow {
  sensor::Motion motion;
  double output = 0.0;
  double output_std = 0.0;  ///< of the reading, in its unit; 0 where nobody knows it
};

struct ModelFitOptions {
  std::vector<sensor::Coefficient> fitted;  ///< each once; K1 should be among them
  sensor::ModelEquation held;               ///< values of the others
};

/// One coefficient that was asked for.
struct FittedCoefficient {
  sensor::Coefficient coefficient = sensor::Coefficient::K0;
  std::optional<Uncertain> value = {};  ///< in the unit of sensor::info()
  double half_width_95 = 0.0;           ///< value ± this holds the truth in 95 % of tests
  /// Variance over what it would be if the other coefficients were known; 0 without a value.
  double variance_inflation = 0.0;
  std::string reason = {};  ///< a sentence, where there is no value
};

/// A sum of coefficients that the rows tell although they do not tell its parts.
struct Combination {
  std::string name;                                           ///< "K2 − Kpp"
  std::vector<std::pair<sensor::Coefficient, double>> parts;  ///< value = Σ factor · coefficient
  Uncertain value;                                            ///< in the unit of the first part
};

/// Coefficients whose terms are tied to each other in every row.
struct Confounded {
  std::vector<sensor::Coefficient> coefficients;
  std::size_t determined = 0;          ///< how many of them could be told, the others being known
  std::vector<std::string> relations;  ///< what ties the terms: "a_p² = 1 g² − a_i²"
  std::vector<Combination> combinations;
  std::string words;  ///< a sentence or two: who is confounded, why, what helps
};

/// Does the stated standard deviation of the readings explain the residuals?
struct ResidualTest {
  double chi_square = 0.0;  ///< Σ (residual/std)²
  double p = 1.0;           ///< of so much or more by chance
};

struct ModelFit {
  sensor::ModelEquation equation;               ///< held values where nothing was determined
  std::vector<FittedCoefficient> coefficients;  ///< in the order asked for
  Eigen::MatrixXd covariance;  ///< of those, in their order; zero where there is no value
  std::vector<Confounded> confounded;
  std::vector<double> residuals;      ///< of the rows, in the unit of the output
  std::vector<std::size_t> suspects;  ///< rows that contradict the others; they stay in the fit
  double residual_rms = 0.0;          ///< √(Σ residual²/rows)
  std::size_t dof = 0;                ///< rows less determined coefficients and combinations
  std::optional<ResidualTest> test;   ///< absent without stated standard deviations or with dof 0
  double scatter = 1.0;               ///< factor on the stated standard deviations, see below
  double condition = 0.0;             ///< of the design, columns of unit length
  bool std_stated = false;            ///< the rows' standard deviations, not the residuals, judge
  std::vector<std::string> notes;     ///< sentences for the user

  [[nodiscard]] const FittedCoefficient* find(sensor::Coefficient coefficient) const;
};

/// Weighted least squares in the products β = K1 · coefficient, in which the equation is linear,
///
///     E − K1 (held terms) = K1 a_i + Σ β_k t_k,     c_k = β_k / K1,
///     cov c = J cov β Jᵀ,   ∂c_k/∂β_k = 1/K1,   ∂c_k/∂K1 = −c_k/K1.
///
/// Where the rows state standard deviations those give the covariance, widened by √(χ²/dof) where
/// the residuals exceed them beyond chance (p < 0.01); otherwise s² = Σ residual²/dof does, and
/// intervals want Student's t with dof.
/// A row is suspect where its residual against a fit to the others would be chance in one of a
/// hundred tests (Bonferroni's bound over the rows): against the stated standard deviation where
/// that explains the other rows, else by Student's t with dof − 1. Source: R. D. Cook, S. Weisberg,
/// Residuals and Influence in Regression (1982), 2.2.
/// Terms that the rows do not excite, and groups of terms that are linearly dependent in all rows
/// to within one part in ten thousand (motion is seldom known better), have no values but reasons;
/// what can be told of a group is among its combinations. Where K1 itself is in such a group the
/// other coefficients are relative to the combination that stands in its place.
///
/// Source: S. Weisberg, Applied Linear Regression, 3rd ed. (2005), sections 5.1 and 10.1;
/// D. A. Belsley, E. Kuh, R. E. Welsch, Regression Diagnostics (1980), chapter 3.
///
/// Errors: too_few_samples (fewer rows than coefficients; none over to judge by, and no stated
/// standard deviation), not_finite, invalid_argument (none asked for, one asked for twice, a
/// standard deviation below zero or stated for part of the rows only), not_observable (K1 is fitted
/// and the rows do not excite it, or it cannot be told from zero).
/// Cost: O(rows · coefficients²).
[[nodiscard]] Result<ModelFit> fit_model_equation(View<ModelRow> rows,
                                                  const ModelFitOptions& options);

}  // namespace proofmass::calibrate
