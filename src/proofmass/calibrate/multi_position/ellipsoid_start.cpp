#include "proofmass/calibrate/multi_position/ellipsoid_start.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

struct Quadric {
  Eigen::Matrix3d A;
  Eigen::Vector3d d;
  double c;
};

enum class Shape { general, axis_parallel, sphere };

// One row of the design: the factors of the coefficients of the shape, d and c.
Eigen::VectorXd design_row(const Eigen::Vector3d& u, Shape shape) {
  const Eigen::Vector3d squares = u.cwiseAbs2();
  const Eigen::Vector4d linear(2.0 * u.x(), 2.0 * u.y(), 2.0 * u.z(), 1.0);
  Eigen::VectorXd row;
  switch (shape) {
    case Shape::general:
      row.resize(10);
      row << squares, 2.0 * u.y() * u.z(), 2.0 * u.x() * u.z(), 2.0 * u.x() * u.y(), linear;
      break;
    case Shape::axis_parallel:
      row.resize(7);
      row << squares, linear;
      break;
    case Shape::sphere:
      row.resize(5);
      row << squares.sum(), linear;
      break;
  }
  return row;
}

Quadric quadric_of(const Eigen::VectorXd& q, Shape shape) {
  Eigen::Vector3d diagonal = Eigen::Vector3d::Constant(q(0)), off = Eigen::Vector3d::Zero();
  if (shape != Shape::sphere) diagonal = q.head<3>();
  if (shape == Shape::general) off = q.segment<3>(3);
  Eigen::Matrix3d A = diagonal.asDiagonal();
  A(1, 2) = A(2, 1) = off(0);
  A(0, 2) = A(2, 0) = off(1);
  A(0, 1) = A(1, 0) = off(2);
  return {A, q.tail<4>().head<3>(), q(q.size() - 1)};
}

// The coefficients of unit length with the least Σ (row · q)².
Quadric fit_quadric(View<NormalisedPose> poses, Shape shape) {
  const Eigen::Index size = design_row(Eigen::Vector3d::Zero(), shape).size();
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(size, size);
  for (const NormalisedPose& pose : poses) {
    const Eigen::VectorXd row = design_row(pose.u, shape);
    N += row * row.transpose();
  }
  return quadric_of(symmetric_eigen(N).vectors.col(0), shape);
}

std::optional<Parameters> parameters_of(Quadric quadric) {
  if (quadric.A.trace() < 0.0) quadric = {-quadric.A, -quadric.d, -quadric.c};
  const Eigen::LLT<Eigen::Matrix3d> positive(quadric.A);
  if (positive.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector3d bias = -positive.solve(quadric.d);
  const double size = bias.dot(quadric.A * bias) - quadric.c;
  if (!(size > 0.0)) return std::nullopt;
  const Eigen::Matrix3d M = Eigen::Matrix3d(positive.matrixU()) / std::sqrt(size);
  Parameters p;
  p << bias, M.diagonal().cwiseInverse(), -M(0, 1) / M(1, 1), M(0, 2) / M(2, 2), -M(1, 2) / M(2, 2);
  if (!p.allFinite()) return std::nullopt;
  return p;
}

double misfit(View<NormalisedPose> poses, const Parameters& p) {
  double sum = 0.0;
  for (const NormalisedPose& pose : poses) {
    const double residual = norm_term(p, pose).residual;
    sum += residual * residual;
  }
  return sum;
}

}  // namespace

Parameters ellipsoid_start(View<NormalisedPose> poses, bool with_misalignment) {
  Parameters best;
  best << Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero();
  double least = misfit(poses, best);
  for (const Shape shape : {Shape::general, Shape::axis_parallel, Shape::sphere}) {
    if (shape == Shape::general && !with_misalignment) continue;
    const std::optional<Parameters> p = parameters_of(fit_quadric(poses, shape));
    if (!p) continue;
    const double sum = misfit(poses, *p);
    if (!(sum < least)) continue;
    least = sum;
    best = *p;
  }
  return best;
}

}  // namespace proofmass::calibrate
