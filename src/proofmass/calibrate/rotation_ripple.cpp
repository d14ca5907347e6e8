#include <algorithm>
#include <array>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/calibrate/rotation_results.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

// Harmonics of both axes relative to S1 that a ripple moves, and by what: rows of M, e = (e_s,
// e_c).
struct RippleModel {
  std::array<Index, 4> seen;  ///< places of the four harmonics that judge
  Eigen::Matrix<double, 4, 2> M;
  Eigen::Matrix<double, 16, 2> moved;  ///< all that it moves
};

// The first axis's C1 is taken up by the phase, which turns the second with it.
void move_phase(Eigen::Matrix<double, 16, 2>& moved) {
  moved.row(10) -= moved.row(2);
  moved.row(2).setZero();
}

// Once a turn: −r ω² and r ω̇ along each axis, with ω = ω̄ (1 + e_s cos φ − e_c sin φ), in g.
void add_radius(const Eigen::VectorXd& harmonics, RippleModel& model) {
  // A ω̄² over K1 g: r ω̄² in g, of each axis.
  const double r1 = harmonics(7) / harmonics(1), r2 = harmonics(15) / harmonics(9);
  auto& moved = model.moved;
  moved(1, 0) += r2;
  moved(1, 1) += 2.0 * r1;
  moved(2, 0) -= 2.0 * r1;
  moved(2, 1) += r2;
  moved(9, 0) -= 2.0 * r2;
  moved(9, 1) -= r1;
  moved(10, 0) += r1;
  moved(10, 1) -= 2.0 * r2;
  move_phase(moved);
}

// With ε = e_s sin nφ + e_c cos nφ the error of the phase, δE = ∂E/∂φ ε in each axis's own phase.
RippleModel ripple_model(int per_turn) {
  RippleModel model{{}, Eigen::Matrix<double, 4, 2>::Zero(), Eigen::Matrix<double, 16, 2>::Zero()};
  auto& moved = model.moved;
  if (per_turn == 1) {
    model.seen = {3, 4, 11, 12};
    moved(3, 0) = moved(4, 1) = moved(0, 1) = 0.5;
    moved(11, 1) = 0.5;
    moved(12, 0) = moved(8, 0) = -0.5;
  } else {
    model.seen = {5, 6, 13, 14};
    moved(1, 0) = moved(5, 0) = moved(2, 1) = moved(6, 1) = 0.5;
    moved(9, 0) = moved(13, 0) = moved(10, 1) = moved(14, 1) = -0.5;
    move_phase(moved);
  }
  for (std::size_t k = 0; k < 4; ++k) model.M.row(static_cast<Index>(k)) = moved.row(model.seen[k]);
  return model;
}

// Hotelling's T² of so many dimensions.
double chance_of(double squared, double dimensions, double dof) {
  const double below = dof - dimensions + 1.0;
  if (below < 1.0) return 1.0;
  return fisher_f_p(std::max(squared, 0.0) * below / (dimensions * dof), dimensions, below);
}

Eigen::Matrix4d inverse_of(const Eigen::Matrix4d& C) {
  // C is 4 × 4 and positive, so that its eigenvalues will do.
  const SymmetricEigen eigen = symmetric_eigen(C);
  const Eigen::Vector4d floor = Eigen::Vector4d::Constant(1e-12 * eigen.values.maxCoeff() + 1e-300);
  const Eigen::Vector4d inverse = eigen.values.cwiseMax(floor).cwiseInverse();
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

void separate_ripples(const RotationState& state, RotationEstimate& estimate, RotationFit& fit) {
  constexpr double beyond_chance = 0.01, ordinary = 0.05;
  for (const int per_turn : {1, 2}) {
    RippleModel model = ripple_model(per_turn);
    if (per_turn == 1 && state.speed_told) add_radius(estimate.harmonics, model);
    // Everything relative to the axis's own S1.
    Eigen::VectorXd scale(16);
    scale << Eigen::VectorXd::Constant(8, estimate.harmonics(1)),
        Eigen::VectorXd::Constant(8, estimate.harmonics(9));
    Eigen::Matrix<double, 4, 16> pick = Eigen::Matrix<double, 4, 16>::Zero();
    for (Index k = 0; k < 4; ++k) {
      const Index at = model.seen[static_cast<std::size_t>(k)];
      pick(k, at) = 1.0 / scale(at);
    }
    const Eigen::Vector4d v = pick * estimate.harmonics;
    const Eigen::Matrix4d C = pick * estimate.covariance() * pick.transpose();
    const Eigen::Matrix4d W = inverse_of(C);
    const Eigen::Matrix2d A = positive_inverse(model.M.transpose() * W * model.M);
    const Eigen::Matrix<double, 2, 4> P = A * model.M.transpose() * W;
    const Eigen::Vector2d e = P * v;
    const Eigen::Vector4d left = v - model.M * e;
    SpeedRipple ripple{.per_turn = per_turn};
    ripple.chance_p = chance_of(v.dot(W * v), 4.0, estimate.dof());
    // The model is one of first order: it holds to a few per cent of the ripple itself.
    const double inexact = 0.05 * 0.5 * e.norm();
    const Eigen::Matrix4d W_model = inverse_of(C + inexact * inexact * Eigen::Matrix4d::Identity());
    ripple.ripple_p = chance_of(left.dot(W_model * left), 2.0, estimate.dof());
    ripple.accepted = ripple.chance_p < beyond_chance && ripple.ripple_p > ordinary;
    // Δω/ω is the derivative of the phase's error by the phase: n times as large.
    const auto size = cross_axis_sensitivity(per_turn * e, per_turn * per_turn * A, estimate.dof());
    if (size && ripple.accepted) ripple.amplitude = size->value;
    fit.ripples.push_back(ripple);
    if (!ripple.accepted) continue;
    const Eigen::MatrixXd L =
        Eigen::MatrixXd::Identity(16, 16) - scale.asDiagonal() * model.moved * P * pick;
    estimate.harmonics = L * estimate.harmonics;
    estimate.blocks.scores = L * estimate.blocks.scores;
  }
}

}  // namespace proofmass::calibrate
