#include "proofmass/calibrate/gyroscope/results.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/so3.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

using NineVector = Eigen::Matrix<double, 9, 1>;
using OffsetMatrix = Eigen::Matrix<double, 12, 12>;
// Positions in the covariance of the fit: relative A, then bias and G.
constexpr Index matrix_at = 0, offset_at = 9;
using FitMatrix = Eigen::Matrix<double, 21, 21>;

// Scale, misalignment and alignment of A = R T diag(1/scale).
NineVector figures_of(const Matrix3d& A) {
  const PositiveQr parts = positive_qr(A);
  const Vector3d scale = parts.U.diagonal().cwiseInverse();
  const Matrix3d T = parts.U * scale.asDiagonal();
  NineVector out;
  out << scale, -T(0, 1), T(0, 2), -T(1, 2), rotation_vector(parts.Q);
  return out;
}

// Derivatives of these by relative A, central differences.
Matrix9 slope_of_figures(const Matrix3d& A, double size) {
  constexpr double h = 1e-6;
  Matrix9 out;
  for (Index k = 0; k < 9; ++k) {
    Matrix3d above = A, below = A;
    above(k / 3, k % 3) += h * size;
    below(k / 3, k % 3) -= h * size;
    out.col(k) = (figures_of(above) - figures_of(below)) / (2.0 * h);
  }
  return out;
}

// Change of the parameters per change of (relative A, bias, G): bias, scale, misalignment,
// alignment, G.
FitMatrix to_parameters(const Matrix3d& A, double size) {
  FitMatrix out = FitMatrix::Zero();
  out.block<3, 3>(0, offset_at).setIdentity();
  out.block<9, 9>(3, matrix_at) = slope_of_figures(A, size);
  out.block<9, 9>(12, offset_at + 3).setIdentity();
  return out;
}

// Covariance of bias and G from the axes' regressions.
OffsetMatrix offset_covariance(const RestRegression& rests) {
  OffsetMatrix out = OffsetMatrix::Zero();
  for (Index axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix4d& own = rests.covariance[static_cast<std::size_t>(axis)];
    const std::array<Index, 4> place{axis, 3 + 3 * axis, 4 + 3 * axis, 5 + 3 * axis};
    for (Index i = 0; i < 4; ++i)
      for (Index j = 0; j < 4; ++j)
        out(place[static_cast<std::size_t>(i)], place[static_cast<std::size_t>(j)]) = own(i, j);
  }
  return out;
}

// What moves A: least squares passes an error of the residuals on by −N⁻¹ Jᵀ W.
MatrixXd gain_of(const MatrixFit& fit) {
  return fit.cofactor * fit.equations.by_matrix.transpose() * fit.weights;
}

GyroscopeShare share_of(
    std::string source, bool type_a, const FitMatrix& to, const FitMatrix& covariance, double dof) {
  GyroscopeShare out{.source = std::move(source), .type_a = type_a, .dof = dof};
  const GyroscopeMatrix C = to * covariance * to.transpose();
  out.covariance = 0.5 * (C + C.transpose());
  return out;
}

// The vertical component of Earth's rotation, at most ω_E, adds A⁻¹ u to a mean at rest with
// gravity along u, as g-sensitivity does. Its variance over all latitudes is ω_E²/3.
FitMatrix earth_in_g(const Matrix3d& A, double gravity_mps2) {
  const Matrix3d per_reading = A.inverse();
  Eigen::Matrix<double, 9, 1> G;
  for (Index i = 0; i < 3; ++i) G.segment<3>(3 * i) = per_reading.row(i).transpose();
  G *= earth_rate_radps / std::sqrt(3.0) / gravity_mps2;
  FitMatrix out = FitMatrix::Zero();
  out.block<9, 9>(offset_at + 3, offset_at + 3) = G * G.transpose();
  return out;
}

std::vector<GyroscopeShare> shares_of(const GyroscopeFit& fit, const MultiPosition& accelerometer) {
  const MatrixFit& matrix = fit.matrix;
  const FitMatrix to = to_parameters(matrix.A, matrix.equations.size);
  const MatrixXd gain = gain_of(matrix);
  std::vector<GyroscopeShare> out;
  // Errors of bias and G at rest, and what they move in A.
  Eigen::Matrix<double, 21, 12> by_offset = Eigen::Matrix<double, 21, 12>::Zero();
  by_offset.topRows<9>() = -gain * matrix.equations.by_offset;
  by_offset.bottomRows<12>().setIdentity();
  const double rest_dof = *std::ranges::min_element(fit.rests.dof);
  out.push_back(share_of("gyroscope at rest", true, to,
                         by_offset * offset_covariance(fit.rests) * by_offset.transpose(),
                         rest_dof));
  FitMatrix own = FitMatrix::Zero();
  own.topLeftCorner<9, 9>() = matrix.scatter.factor * matrix.cofactor;
  out.push_back(share_of("motions", true, to, own, matrix.scatter.dof));
  const Matrix9 by_accel = -gain * matrix.equations.by_accel;
  own.topLeftCorner<9, 9>() = by_accel * accelerometer.covariance * by_accel.transpose();
  out.push_back(share_of("accelerometer's calibration", false, to, own, 0.0));
  if (!fit.latitude_known && fit.rests.why_no_g.empty())
    out.push_back(share_of("Earth's rotation, unknown latitude", false, to,
                           earth_in_g(matrix.A, accelerometer.gravity_mps2), 0.0));
  return out;
}

// Axes of the gyroscope whose column of A is not determined: "x, z".
std::string undetermined_axes(const MatrixFit& fit) {
  constexpr double present = 0.1;
  std::string out;
  for (Index axis = 0; axis < 3; ++axis) {
    double share = 0.0;
    for (Index i = 0; i < 3; ++i) share += fit.undetermined(3 * i + axis, 3 * i + axis);
    if (share > present) out += (out.empty() ? "" : ", ") + std::string(1, "xyz"[axis]);
  }
  return out;
}

void set_reasons(const GyroscopeFit& fit, std::size_t motions, GyroscopeCalibration& out) {
  const Matrix9 slope = slope_of_figures(fit.matrix.A, fit.matrix.equations.size);
  const std::string axes = undetermined_axes(fit.matrix);
  // A parameter is determined if it hardly changes along what is not.
  constexpr double least_change = 0.02;
  for (Index k = 0; k < 9; ++k) {
    const double size = slope.row(k).norm();
    const double open = (slope.row(k) * fit.matrix.undetermined).norm();
    if (open < least_change * size) continue;
    out.why_absent[static_cast<std::size_t>(3 + k)] =
        motions == 0 && k >= 6
            ? "the rates of a turntable do not show the alignment: it needs motions between rests"
            : fmt::format(
                  "the motions do not turn the sensor enough about its axis {} with that "
                  "axis away from the vertical",
                  axes);
  }
  for (std::size_t k = 12; k < gyroscope_parameters; ++k) out.why_absent[k] = fit.rests.why_no_g;
}

void set_motions(const GyroscopeData& data, const MatrixFit& fit, GyroscopeCalibration& out) {
  out.motions = data.residuals;
  double squares = 0.0, left_out = 0.0;
  std::size_t count = 0, judged = 0;
  for (std::size_t k = 0; k < fit.used.size(); ++k) {
    MotionResidual& motion = out.motions[data.listed[k]];
    if (!fit.used[k]) {
      motion.used = false;
      motion.why_unused = "contradicts the others";
      continue;
    }
    const auto row = static_cast<Index>(2 * count);
    motion.turned_rad = fit.equations.turned_rad[count];
    motion.residual_rad = fit.equations.residual.segment<2>(row).norm();
    motion.predicted_std_rad =
        std::sqrt(0.5 * fit.equations.covariance.block<2, 2>(row, row).trace());
    motion.leave_one_out_rad = fit.leave_one_out_rad[count];
    motion.studentised = fit.studentised[count];
    // The scatter is known only up to the factor of the fit.
    if (motion.studentised) *motion.studentised /= std::sqrt(std::max(fit.scatter.factor, 1e-300));
    squares += motion.residual_rad * motion.residual_rad;
    ++count;
    if (!motion.leave_one_out_rad) continue;
    left_out += *motion.leave_one_out_rad * *motion.leave_one_out_rad;
    ++judged;
  }
  if (count > 0) out.residual_rms_rad = std::sqrt(squares / static_cast<double>(count));
  if (judged > 0) out.leave_one_out_rms_rad = std::sqrt(left_out / static_cast<double>(judged));
}

void set_rates(const GyroscopeData& data, const MatrixFit& fit, GyroscopeCalibration& out) {
  const auto n = static_cast<Index>(data.rates.size());
  const Index first = fit.equations.residual.size() - n;
  for (Index k = 0; k < n; ++k)
    out.rates.push_back({data.rates[static_cast<std::size_t>(k)].rate_radps,
                         fit.equations.residual(first + k),
                         std::sqrt(fit.equations.covariance(first + k, first + k))});
}

}  // namespace

GyroscopeCalibration gyroscope_results(const GyroscopeData& data,
                                       const GyroscopeFit& fit,
                                       const MultiPosition& accelerometer) {
  GyroscopeCalibration out;
  out.matrix = fit.matrix.A;
  out.estimate.head<3>() = fit.rests.bias;
  out.estimate.segment<9>(3) = figures_of(fit.matrix.A);
  for (Index i = 0; i < 3; ++i)
    out.estimate.segment<3>(12 + 3 * i) = fit.rests.G.row(i).transpose();
  out.shares = shares_of(fit, accelerometer);
  for (const GyroscopeShare& share : out.shares) out.covariance += share.covariance;
  for (std::size_t k = 0; k < gyroscope_parameters; ++k)
    out.dof[k] = k < 3    ? fit.rests.dof[k]
                 : k < 12 ? fit.matrix.scatter.dof
                          : fit.rests.dof[(k - 12) / 3];
  set_motions(data, fit.matrix, out);
  set_rates(data, fit.matrix, out);
  set_reasons(fit, fit.matrix.equations.turned_rad.size(), out);
  out.lack_of_fit = fit.matrix.scatter.lack_of_fit;
  out.rests_lack_of_fit = fit.rests.lack_of_fit;
  const Vector3d per_reading = fit.matrix.A.colwise().norm().transpose();
  for (Index axis = 0; axis < 3; ++axis)
    out.angle_random_walk[static_cast<std::size_t>(axis)] =
        per_reading(axis) * std::sqrt(data.white(axis));
  out.iterations = fit.matrix.iterations;
  out.converged = fit.matrix.converged;
  return out;
}

}  // namespace proofmass::calibrate
