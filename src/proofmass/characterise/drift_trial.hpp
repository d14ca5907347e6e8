#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "proofmass/characterise/drift_evidence.hpp"
#include "proofmass/characterise/drift_model.hpp"
#include "proofmass/characterise/drift_noise.hpp"
#include "proofmass/characterise/ordinate_likelihood.hpp"

namespace proofmass::characterise {

/// A shape with what of it is not linear.
struct ShapeAt {
  DriftShape shape = DriftShape::constant;
  std::vector<double> log_times;         ///< ln T of each exponential, or ln τ of a rival
  std::vector<std::size_t> step_blocks;  ///< where the steps begin
};

/// Columns at k ≥ 1 of what is linear in the shape, the level apart:
/// [exponentials or the rival's columns, line, steps, missing blocks].
[[nodiscard]] Eigen::MatrixXd linear_columns(const DriftEvidence& evidence, const ShapeAt& at);

/// Those, and the derivatives by each ln T for an amplitude of 1; of the sine two.
[[nodiscard]] Eigen::MatrixXd tangent_columns(const DriftEvidence& evidence, const ShapeAt& at);

/// Derivative by ln τ of a rival with these amplitudes, k = 0 too.
[[nodiscard]] Eigen::VectorXd rival_by_log_scale(const DriftEvidence& evidence,
                                                 const ShapeAt& at,
                                                 const Eigen::VectorXd& amplitudes);

/// linear_columns with k = 0.
[[nodiscard]] Eigen::MatrixXd whole_columns(const DriftEvidence& evidence, const ShapeAt& at);

/// Time constants are looked for between two blocks, less where there are fewer than 60, and ten
/// times the record.
struct TimeRange {
  double lower_s = 0.0, upper_s = 0.0;
};
[[nodiscard]] TimeRange time_range(const DriftEvidence& evidence);

/// A shape fitted with its noise.
struct DriftTrial {
  ShapeAt at;
  NoiseColumns noise;
  OrdinateFit fit;           ///< by restricted likelihood; coefficients as linear_columns
  DriftCandidate candidate;  ///< by likelihood, to compare shapes

  /// Akaike's criterion −2 ln L + 2 k, by which shapes fit as well or not.
  [[nodiscard]] double akaike() const {
    return -2.0 * candidate.log_likelihood + 2.0 * candidate.parameters;
  }
};

/// Fits a shape: time constants and noise in turn, the first by variable projection over whitened
/// ordinates, the second by restricted likelihood, from the best of a grid of time constants; steps
/// one after the other while each gains 3 ln n in twice the log-likelihood.
[[nodiscard]] DriftTrial try_shape(const DriftEvidence& evidence,
                                   const NoiseChoice& choice,
                                   DriftShape shape);

}  // namespace proofmass::characterise
