#include "proofmass/calibrate/rotating/pass.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

RotationNormal empty_normal(const RotationState& state) {
  const Index size = state.size();
  RotationNormal normal;
  normal.H = Eigen::MatrixXd::Zero(size, size);
  normal.g = Eigen::VectorXd::Zero(size);
  if (state.angle_given) return normal;
  for (const PhaseSpline& spline : state.splines) {
    const Index knots = spline.c.size();
    normal.sections.push_back({Eigen::MatrixXd::Zero(size, knots),
                               Eigen::MatrixXd::Zero(knots, knots), Eigen::VectorXd::Zero(knots)});
  }
  return normal;
}

// Sets unfitted terms to a unit diagonal, so that the matrix stays invertible.
void leave_out_unfitted(const RotationState& state, Eigen::MatrixXd& H) {
  for (Index k = 0; k < state.size(); ++k) {
    if (state.fitted(k)) continue;
    H.row(k).setZero();
    H.col(k).setZero();
    H(k, k) = 1.0;
  }
}

// A⁻¹ with rows and columns brought to one unit first.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * positive_inverse(scale.asDiagonal() * A * scale.asDiagonal()) *
         scale.asDiagonal();
}

// Blocks of whole turns: how many in each section.
std::vector<std::size_t> blocks_per_section(const RotationState& state, double& turns_per_block) {
  constexpr double wanted = 24.0, least_turns = 4.0, at_least = 12.0, in_each = 2.0;
  std::size_t turns = 0;
  for (const SteadyTurns& one : state.sections) turns += one.turn_s.size() - 1;
  const auto all = static_cast<double>(turns);
  turns_per_block =
      std::max({1.0, std::floor(all / wanted), std::min(least_turns, std::floor(all / at_least))});
  std::vector<std::size_t> blocks;
  for (const SteadyTurns& one : state.sections) {
    const auto in_section = static_cast<double>(one.turn_s.size() - 1);
    blocks.push_back(
        static_cast<std::size_t>(std::max(in_each, std::floor(in_section / turns_per_block))));
  }
  return blocks;
}

}  // namespace

void place(const RotationState& state, const RotationRecording& recording, RotationSample& sample) {
  const PhaseSpline& spline = state.splines[sample.section];
  const double even = spline.value(sample.local), even_speed = spline.slope_per_s(sample.local);
  sample.theta = state.angle_given ? recording.angle_rad[sample.k] : even;
  const RippleAt ripple =
      ripple_at(state.ripples[sample.section], state.offset[0] + state.direction * sample.theta);
  // An encoder's ripple is a function of the angle itself, else one of the even phase.
  const double stretch = state.angle_given ? 1.0 / (1.0 - ripple.slope) : 1.0;
  if (!state.angle_given) sample.theta += state.direction * ripple.value;
  const double speed = state.angle_given ? even_speed * stretch : even_speed * (1.0 + ripple.slope);
  const double mean = state.mean_square_speed;
  sample.speed_squared = speed * speed;
  if (mean <= 0.0) return;  // before it is known
  sample.relative_acceleration =
      even_speed * even_speed * ripple.curvature * stretch * stretch * stretch / mean;
  if (state.angle_given)
    sample.relative_speed = state.direction * state.sense[sample.section] * speed / std::sqrt(mean);
}

double tangential_distance(const RotationState& state, std::size_t axis) {
  if (!state.speed_determined || state.axes < 2) return 0.0;
  const Harmonics &own = state.harmonics[axis], &other = state.harmonics[1 - axis];
  if (own(1) == 0.0 || other(1) == 0.0) return 0.0;
  const double distance = own(1) * other(square_speed_column) / other(1);
  return axis == 0 ? distance : -distance;
}

AxisAt axis_at(const RotationState& state,
               std::size_t axis,
               const RotationSample& sample,
               double reading) {
  AxisAt at;
  at.columns = columns_at({.phase = state.offset[axis] + state.direction * sample.theta,
                           .relative_square_speed = sample.speed_squared / state.mean_square_speed,
                           .relative_speed = sample.relative_speed});
  at.residual = reading - at.columns.dot(state.harmonics[axis]);
  at.slope = state.direction * slope_at(at.columns, state.harmonics[axis]);
  at.residual += tangential_distance(state, axis) * sample.relative_acceleration;
  return at;
}

RotationNormal normal_equations(const RotationState& state) {
  RotationNormal normal = empty_normal(state);
  for_each_sample(state, [&](const RotationRecording& recording, const RotationSample& sample) {
    for (std::size_t axis = 0; axis < state.axes; ++axis) {
      const AxisAt at = axis_at(state, axis, sample, recording.axes[axis][sample.k]);
      if (!std::isfinite(at.residual)) continue;
      const double weight = 1.0 / state.variance[axis];
      const Index from = harmonic_count * static_cast<Index>(axis);
      normal.squares[axis] += at.residual * at.residual;
      ++normal.count[axis];
      normal.H.block<harmonic_count, harmonic_count>(from, from) +=
          weight * at.columns * at.columns.transpose();
      normal.g.segment<harmonic_count>(from) += weight * at.residual * at.columns;
      if (state.angle_given) continue;
      RotationNormal::Section& section = normal.sections[sample.section];
      const Index knot = sample.local.first;
      const Eigen::Vector4d basis = at.slope * sample.local.value;
      section.cross.block<harmonic_count, 4>(from, knot) += weight * at.columns * basis.transpose();
      section.H.block<4, 4>(knot, knot) += weight * basis * basis.transpose();
      section.g.segment<4>(knot) += weight * at.residual * basis;
    }
  });
  return normal;
}

RotationSolver make_solver(const RotationState& state, const RotationNormal& normal) {
  RotationSolver solver;
  Eigen::MatrixXd S = normal.H;
  for (const RotationNormal::Section& section : normal.sections) {
    solver.spline_inverse.push_back(scaled_inverse(section.H));
    solver.elimination.push_back(section.cross * solver.spline_inverse.back());
    S -= solver.elimination.back() * section.cross.transpose();
  }
  leave_out_unfitted(state, S);
  solver.inverse = scaled_inverse(S);
  for (Index k = 0; k < state.size(); ++k) {
    if (!state.fitted(k)) solver.inverse(k, k) = 0.0;
  }
  return solver;
}

double step(RotationState& state, bool move_phase) {
  RotationNormal normal = normal_equations(state);
  if (!move_phase) normal.sections.clear();
  const RotationSolver solver = make_solver(state, normal);
  Eigen::VectorXd g = normal.g;
  for (std::size_t s = 0; s < normal.sections.size(); ++s) {
    g -= solver.elimination[s] * normal.sections[s].g;
  }
  const Eigen::VectorXd change = solver.inverse * g;
  double largest = 0.0;
  for (std::size_t s = 0; s < normal.sections.size(); ++s) {
    const RotationNormal::Section& section = normal.sections[s];
    const Eigen::VectorXd phase =
        solver.spline_inverse[s] * (section.g - section.cross.transpose() * change);
    state.splines[s].c += phase;
    largest = std::max(largest, phase.cwiseAbs().maxCoeff());
  }
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const Harmonics by = change.segment<harmonic_count>(harmonic_count * static_cast<Index>(axis));
    state.harmonics[axis] += by;
    const double size = std::abs(state.harmonics[axis](1));
    if (size > 0.0) largest = std::max(largest, by.cwiseAbs().maxCoeff() / size);
    const double tiny = 1e-30 * size * size;
    if (normal.count[axis] > 0 && normal.squares[axis] > tiny) {
      state.variance[axis] = normal.squares[axis] / static_cast<double>(normal.count[axis]);
    }
  }
  return largest;
}

BlockScores block_scores(const RotationState& state, const RotationSolver& solver) {
  BlockScores result;
  const std::vector<std::size_t> blocks = blocks_per_section(state, result.turns_per_block);
  std::vector<Index> first{0};
  for (std::size_t s = 0; s < blocks.size(); ++s) {
    first.push_back(first.back() + static_cast<Index>(blocks[s]));
    result.section.insert(result.section.end(), blocks[s], s);
  }
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(state.size(), first.back());
  for_each_sample(state, [&](const RotationRecording& recording, const RotationSample& sample) {
    const SteadyTurns& section = state.sections[sample.section];
    const auto after = std::ranges::upper_bound(section.turn_s, recording.time_s[sample.k]);
    const auto turn = static_cast<std::size_t>(after - section.turn_s.begin()) - 1;
    const std::size_t turns = section.turn_s.size() - 1, count = blocks[sample.section];
    const auto in_section = static_cast<Index>(std::min(turn * count / turns, count - 1));
    auto gradient = gradients.col(first[sample.section] + in_section);
    for (std::size_t axis = 0; axis < state.axes; ++axis) {
      const AxisAt at = axis_at(state, axis, sample, recording.axes[axis][sample.k]);
      if (!std::isfinite(at.residual)) continue;
      const double weighted = at.residual / state.variance[axis];
      gradient.segment<harmonic_count>(harmonic_count * static_cast<Index>(axis)) +=
          weighted * at.columns;
      if (state.angle_given) continue;
      gradient -= solver.elimination[sample.section].middleCols<4>(sample.local.first) *
                  (weighted * at.slope * sample.local.value);
    }
  });
  result.scores = solver.inverse * gradients;
  result.gradients = std::move(gradients);
  return result;
}

}  // namespace proofmass::calibrate
