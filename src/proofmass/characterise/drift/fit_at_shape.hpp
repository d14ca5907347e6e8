#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift/noise.hpp"
#include "proofmass/characterise/drift_model.hpp"
#include "proofmass/characterise/noise/ordinate_likelihood.hpp"

namespace proofmass::characterise {

/// A shape with its nonlinear parameters.
struct ShapeAt {
  DriftShape shape = DriftShape::constant;
  std::vector<double> log_times;         ///< ln T of each exponential, or ln τ of a rival
  std::vector<std::size_t> step_blocks;  ///< where the steps begin
};

/// Columns at k ≥ 1 of the linear parameters of the shape, without the level: [exponentials or the
/// rival's columns, line, steps, missing blocks].
[[nodiscard]] Eigen::MatrixXd linear_columns(const DriftEvidence& evidence, const ShapeAt& at);

/// Those, and before the missing blocks the derivatives by each ln T for an amplitude of 1; two for
/// the sine.
[[nodiscard]] Eigen::MatrixXd tangent_columns(const DriftEvidence& evidence, const ShapeAt& at);

/// The linear columns fitted, with the restricted likelihood of the tangent columns.
[[nodiscard]] OrdinateMeans restricted(const DriftEvidence& evidence, const ShapeAt& at);

/// Derivative by ln τ of a rival with these amplitudes, k = 0 too.
[[nodiscard]] Eigen::VectorXd rival_by_log_scale(const DriftEvidence& evidence,
                                                 const ShapeAt& at,
                                                 const Eigen::VectorXd& amplitudes);

/// linear_columns with k = 0.
[[nodiscard]] Eigen::MatrixXd whole_columns(const DriftEvidence& evidence, const ShapeAt& at);

/// Range of time constants: two blocks, or fewer if there are less than 60, to ten times the
/// record.
struct TimeRange {
  double lower_s = 0.0, upper_s = 0.0;
};
[[nodiscard]] TimeRange time_range(const DriftEvidence& evidence);

/// A shape fitted with its noise.
struct DriftFitAtShape {
  ShapeAt at;
  NoiseColumns noise;
  OrdinateFit fit;           ///< by restricted likelihood; coefficients as linear_columns
  DriftCandidate candidate;  ///< by likelihood, to compare shapes

  /// Akaike's criterion −2 ln L + 2 k, to compare shapes.
  [[nodiscard]] double akaike() const {
    return -2.0 * candidate.log_likelihood + 2.0 * candidate.parameters;
  }
};

/// Fits a shape: alternates time constants, by variable projection over whitened ordinates, and
/// noise, by restricted likelihood, from the best of a grid of time constants; steps are added one
/// by one while each gains 3 ln n in twice the log-likelihood.
[[nodiscard]] DriftFitAtShape try_shape(const DriftEvidence& evidence,
                                        const NoiseChoice& choice,
                                        DriftShape shape);

}  // namespace proofmass::characterise
