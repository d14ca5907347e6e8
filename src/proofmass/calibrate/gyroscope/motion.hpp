#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

// Rotation between two static positions, and its derivatives.
namespace proofmass::calibrate {

/// Readings during a motion, from the last sample of one rest to the first of the next.
struct MotionSamples {
  std::vector<double> step_s;            ///< from sample n to n + 1
  std::vector<Eigen::Vector3d> reading;  ///< gyroscope less the mean of the adjacent rests
  std::vector<Eigen::Vector3d> force;    ///< specific force less the mean of the rests, m/s^2
  double stamp_std_s = 0.0;              ///< jitter of the stamps

  [[nodiscard]] double duration_s() const;
};

/// R takes vectors from the frame at the end to that at the start. An error δω(t) of the rate, in
/// the sensor's frame, rotates the frame at the end by the vector δφ = Σ Pₙ δωₙ dt, Pₙ the rotation
/// from sample n to the end.
struct MotionRotation {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 9> by_matrix;  ///< δφ per δA, row by row
  Eigen::Matrix<double, 3, 9> by_g;       ///< δφ per δG, row by row
  Eigen::Matrix3d by_rate;                ///< δφ per constant δω
  /// Covariance of δφ by white noise, Σ Pₙ A diag(N²) Aᵀ Pₙᵀ dt, and by the jitter τ of the stamps,
  /// each of which shifts the change of the rate from one step to the next: Σ Pₙ Δωₙ Δωₙᵀ Pₙᵀ τ².
  Eigen::Matrix3d noise;
  double turned_rad = 0.0;
};

/// Integrates ω = A (reading − G force) by the fourth-order Magnus expansion with the rate linear
/// between samples,
///
///     φ = ½ (ω₀ + ω₁) dt + (ω₀ × ω₁) dt²/12,
///
/// which includes the coning of the two. noise_axes: N² of each axis, reading²·s.
///
/// Source: A. Iserles, S. P. Nørsett, On the solution of linear differential equations in Lie
/// groups, Phil. Trans. R. Soc. A 357 (1999) 983. Cost: O(samples).
[[nodiscard]] MotionRotation integrate(const MotionSamples& motion,
                                       const Eigen::Matrix3d& A,
                                       const Eigen::Matrix3d& G,
                                       const Eigen::Vector3d& noise_axes);

}  // namespace proofmass::calibrate
