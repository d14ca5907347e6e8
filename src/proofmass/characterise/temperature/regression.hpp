#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/characterise/drift/drifting_noise.hpp"
#include "proofmass/characterise/temperature/blocks.hpp"
#include "proofmass/characterise/temperature_model.hpp"

namespace proofmass::characterise {

inline constexpr double normal_975 = 1.959964;  ///< quantile of the normal distribution

/// Common data of the regressions. The columns are hysteresis (optional), p0 … of the highest
/// degree, y, so that the first ones also serve a lower degree.
struct TemperatureProblem {
  Eigen::MatrixXd columns;
  Eigen::VectorXd crowds;
  DriftingNoise noise;
  Eigen::MatrixXd drift;    ///< covariance of the noise without its white part
  Eigen::MatrixXd inverse;  ///< V⁻¹ of the weights
  Eigen::Index level = 0;   ///< column of p0
  int most_degree = 0;

  [[nodiscard]] Eigen::Index causes(int degree) const { return level + degree + 1; }
};

struct TemperatureCurve {
  Eigen::VectorXd values;  ///< of hysteresis (optional), b_0, b_1, …
  Eigen::MatrixXd covariance;
};

/// `polynomials` are their means over the blocks. Cost: O(blocks³).
[[nodiscard]] TemperatureProblem temperature_problem(const TemperatureBlocks& of,
                                                     const Eigen::MatrixXd& polynomials);

[[nodiscard]] TemperatureCurve fit_curve(const TemperatureProblem& problem, int degree);

/// By degree, ascending from 0.
[[nodiscard]] std::vector<DegreeScore> cross_validate(const TemperatureProblem& problem);

/// The rule of one standard error, then only terms significant by their own interval.
[[nodiscard]] int chosen_degree(const TemperatureProblem& problem,
                                const std::vector<DegreeScore>& scores);

}  // namespace proofmass::characterise
