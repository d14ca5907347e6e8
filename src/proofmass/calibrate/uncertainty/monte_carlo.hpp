#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "proofmass/calibrate/uncertainty_budget.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Uncertainty of a result by Monte Carlo, and its comparison with the budget. Source: JCGM
// 101:2008, Propagation of distributions using a Monte Carlo method.
namespace proofmass::calibrate {

/// Distribution of one input.
struct Input {
  double value = 0.0;
  double std = 0.0;  ///< as in BudgetLine: student_t is drawn as std · t(dof), which is wider
  Distribution distribution = Distribution::normal;
  double dof = 0.0;  ///< of student_t; 0: infinite, i.e. normal
};

/// y = f(x); NaN if a draw has no result.
using Measurement = std::function<double(View<double> inputs)>;

struct PropagateOptions {
  std::size_t draws = 200000;
  std::uint64_t seed = 1;
  Eigen::MatrixXd correlation = {};  ///< of the inputs, then all normal; empty: none
};

struct Interval {
  double lower = 0.0, upper = 0.0;
};

/// The distribution of a result.
struct Propagation {
  std::size_t draws = 0;    ///< with a result
  std::size_t without = 0;  ///< draws without a result
  double mean = 0.0;
  double std = 0.0;
  Interval shortest_95;           ///< the shortest that holds 95 % of the draws
  Interval symmetric_95;          ///< between the 2.5 % and the 97.5 % quantile
  Interval lower_end, upper_end;  ///< 95 % limits of symmetric_95's ends
};

/// Summary of the results of draws. Non-finite draws count as `without`. Errors: too_few_samples
/// (fewer than 100 finite draws).
[[nodiscard]] Result<Propagation> summary_of(std::vector<double> draws);

/// Draws the inputs, identically on every machine for a given seed, and summarises f. Source: JCGM
/// 101, clauses 5.9 and 7. Errors: those of summary_of; not_finite, invalid_argument (invalid
/// inputs or correlation, correlated inputs that are not normal).
[[nodiscard]] Result<Propagation> propagate(const Measurement& f,
                                            View<Input> inputs,
                                            const PropagateOptions& options = {});

/// Whether the budget and the draws give the same interval.
enum class Agreement {
  yes,
  no,
  cannot_tell,  ///< too few draws for the tolerance
};

/// Half of the last of `digits` significant digits of a standard uncertainty; 0 if that is 0.
/// Source: JCGM 101, clause 7.9.2.
[[nodiscard]] double numerical_tolerance(double std, int digits);

struct GumValidation {
  double tolerance = 0.0;  ///< δ: half of the last significant digit of u_c
  double lower_difference = 0.0, upper_difference = 0.0;  ///< |y ∓ U − the draws' end|
  Agreement agreement = Agreement::cannot_tell;
  std::string verdict;  ///< one sentence
};

/// Compares y ± U with the draws' symmetric 95 % interval: they agree if both ends do within half
/// of the last of `digits` (1 or 2) significant digits of u_c. Source: JCGM 101, clause 8.1,
/// including the statistical uncertainty of the draws (8.2).
[[nodiscard]] GumValidation validate(const UncertaintyBudget& budget,
                                     const Propagation& drawn,
                                     int digits = 2);

}  // namespace proofmass::calibrate
