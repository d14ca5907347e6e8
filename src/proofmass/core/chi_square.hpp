#pragma once

#include <cstddef>

namespace proofmass {

/// The p-quantile of the chi-square distribution with k degrees of freedom, p in (0, 1), k > 0.
[[nodiscard]] double chi_square_quantile(double p, double degrees_of_freedom);

/// The probability that a chi-square variable with k > 0 degrees of freedom exceeds `statistic`.
[[nodiscard]] double chi_square_p(double statistic, double degrees_of_freedom);

/// The p-quantile of the standard normal distribution, p in (0, 1).
[[nodiscard]] double normal_quantile(double p);

/// The p-quantile of Student's t distribution with k degrees of freedom, p in (0, 1), k > 0.
[[nodiscard]] double student_t_quantile(double p, double degrees_of_freedom);

/// The probability that the magnitude of Student's t with k > 0 degrees of freedom exceeds |t|.
[[nodiscard]] double student_t_p(double t, double degrees_of_freedom);

/// The probability that Fisher's F, with these degrees of freedom above and below, exceeds
/// `statistic` >= 0.
[[nodiscard]] double fisher_f_p(double statistic, double dof_above, double dof_below);

struct Bounds {
  double lower = 0.0, upper = 0.0;
};

/// 95 % interval of the mean of `count` independent chi-square variables of one degree of freedom.
/// Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications (2001), section 5.4.2.
[[nodiscard]] Bounds mean_chi_square_95(std::size_t count);

}  // namespace proofmass
