#pragma once

#include <optional>
#include <string>

#include "proofmass/estimate/motor/identify.hpp"

namespace proofmass::estimate::motor {

/// Electrical, then Mechanical, then half the backlash: the coefficients of an identification with
/// a current.
constexpr Eigen::Index joint_count =
    Eigen::Index{electrical_count} + Eigen::Index{mechanical_count} + 1;
[[nodiscard]] Eigen::VectorXd joint_coefficients(const Identified& found);

/// What errors of the measured current do to the coefficients.
struct CurrentErrors {
  Eigen::VectorXd shift;       ///< to be added
  Eigen::MatrixXd covariance;  ///< of what remains
};

/// Why the current cannot be used: its converter's steps are too coarse beside it.
[[nodiscard]] std::optional<std::string> unusable_current(const MotorRecord& record);

/// A regression takes its columns as exact: noise of the current attenuates the coefficients that
/// multiply it. The identification is repeated with the noise once more in the current, and the
/// shift that it causes is subtracted, and remains as an uncertainty. Where the converter's
/// steps exceed the noise, the mean error within each step is drawn at random as well.
///
/// Zero without a current. Source: J. R. Cook, L. A. Stefanski, Simulation-extrapolation estimation
/// in parametric measurement error models, J. Amer. Statist. Assoc. 89 (1994) 1314.
[[nodiscard]] CurrentErrors current_errors(const MotorRecord& record,
                                           const MotorOptions& options,
                                           const Identified& found);

}  // namespace proofmass::estimate::motor
