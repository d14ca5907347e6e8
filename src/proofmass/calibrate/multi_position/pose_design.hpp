#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/core/view.hpp"

// What the positions of a calibration determine, and which further one adds most.
namespace proofmass::calibrate {

/// What these poses do not determine, from the weakest direction of the weighted Jacobian: "do not
/// separate bias z and scale z", "do not determine scale z". `information` is JᵀWJ of the free
/// parameters.
[[nodiscard]] std::string unresolved(const Eigen::MatrixXd& information);

/// The free parameters' standard deviations as errors at 1 g, in g: bias/scale, scale/scale, angle.
/// `covariance` is that of the normalised parameters p.
[[nodiscard]] Eigen::VectorXd errors_at_1g(const Eigen::MatrixXd& covariance, const Parameters& p);

inline constexpr double taken_rad = 15.0 * rad_per_deg;

/// The position whose |f| the fit predicts with the largest variance, which adds most to ln |JᵀWJ|
/// (D-optimal), among the 26 on the faces, edges and corners of a cube about the sensor.
/// Source: V. V. Fedorov, Theory of Optimal Experiments (1972), section 2.7.
[[nodiscard]] NextPose next_pose(const Eigen::MatrixXd& information,
                                 const Parameters& p,
                                 double residual_variance,
                                 View<Eigen::Vector3d> taken = {});

}  // namespace proofmass::calibrate
