#include "proofmass/calibrate/rotating/ripple.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

constexpr Index parts = 2 * highest_ripple;
// Those confounded with the sensor's terms: once a turn cos and sin, twice a turn sin.
constexpr std::array<Index, 3> shared{0, 1, 3};
constexpr double normal_95 = 1.959964;
constexpr double inexact = 1.05;  // the model of first order holds to a few per cent

// Adds a cos nφ + b sin nφ, φ the phase of the first axis, to an axis's harmonics.
void add_harmonic(std::size_t axis, int n, Eigen::Vector2d ab, Eigen::Ref<Eigen::VectorXd> into) {
  if (n > highest_harmonic) return;
  const Index from = harmonic_count * static_cast<Index>(axis);
  if (n == 0) {
    into(from) += ab(0);
    return;
  }
  // φ is a quarter turn less than the second axis's own phase.
  const double back = axis == 0 ? 0.0 : 0.5 * std::numbers::pi * n;
  const double c = std::cos(back), s = std::sin(back);
  into(from + sine_column(n)) += s * ab(0) + c * ab(1);
  into(from + sine_column(n) + 1) += c * ab(0) - s * ab(1);
}

// The first axis's C1 is absorbed by the phase, which shifts the second with it.
void keep_phase(Eigen::Ref<Eigen::VectorXd> moved) {
  const double by = moved(2);
  for (Index from = 0; from < moved.size(); from += harmonic_count) moved(from + 2) -= by;
}

// The sensor's terms that differ from a ripple: q₁ − p₂, p₁ + q₂, t₁ + t₂ of 1.
Eigen::MatrixXd sensor_terms() {
  Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(2 * harmonic_count, 3);
  const Index p = sine_column(2), q = p + 1, t = sine_column(3), second = harmonic_count;
  terms(q, 0) = 0.5;
  terms(second + p, 0) = -0.5;
  terms(p, 1) = terms(second + q, 1) = 0.5;
  terms(t, 2) = terms(second + t, 2) = 0.5;
  return terms;
}

// p-value by Hotelling's T² in this many dimensions.
double chance_of(const Eigen::VectorXd& v, const Eigen::MatrixXd& C, double dof) {
  const auto dimensions = static_cast<double>(v.size());
  const double below = dof - dimensions + 1.0;
  if (below < 1.0 || !(C.trace() > 0.0)) return 1.0;
  const double squared = v.dot(positive_inverse(C) * v);
  return fisher_f_p(std::max(squared, 0.0) * below / (dimensions * dof), dimensions, below);
}

// Share of each section in the turns.
std::vector<double> shares(const RotationState& state) {
  double turns = 0.0;
  std::vector<double> share;
  for (const SteadyTurns& one : state.sections) {
    share.push_back(static_cast<double>(one.turn_s.size() - 1));
    turns += share.back();
  }
  for (double& one : share) one /= turns;
  return share;
}

struct RippleMoments {
  Ripple mean = Ripple::Zero(), rms = Ripple::Zero();
};

// Over the sections, by their turns.
RippleMoments ripple_moments(const RotationState& state) {
  RippleMoments out;
  const std::vector<double> share = shares(state);
  for (std::size_t s = 0; s < share.size(); ++s) {
    out.mean += share[s] * state.ripples[s];
    out.rms += share[s] * state.ripples[s].cwiseAbs2();
  }
  out.rms = out.rms.cwiseSqrt();
  return out;
}

// All axes' harmonics, concatenated.
Eigen::VectorXd stacked(const RotationState& state) {
  Eigen::VectorXd all(state.size());
  for (std::size_t axis = 0; axis < state.axes; ++axis)
    all.segment<harmonic_count>(harmonic_count * static_cast<Index>(axis)) = state.harmonics[axis];
  return all;
}

// S1 of each axis, as often as it has harmonics.
Eigen::VectorXd scale_of(const Eigen::VectorXd& harmonics) {
  Eigen::VectorXd scale(harmonics.size());
  for (Index from = 0; from < harmonics.size(); from += harmonic_count)
    scale.segment<harmonic_count>(from).setConstant(harmonics(from + 1));
  return scale;
}

// ∂E/∂(a_n, b_n) of an axis at a sample: by the phase, and by r ω² and r ω̇ where r is known.
Ripple ripple_columns(const RotationState& state,
                      std::size_t axis,
                      const RotationSample& sample,
                      const AxisAt& at) {
  const PhaseSpline& spline = state.splines[sample.section];
  const double phase = state.offset[0] + state.direction * spline.value(sample.local);
  const double even = spline.slope_per_s(sample.local), mean = state.mean_square_speed;
  const double by_phase = state.direction * at.slope;
  const double by_slope = -2.0 * state.harmonics[axis](square_speed_column) * even *
                          std::sqrt(sample.speed_squared) / mean;
  const double by_curvature = -tangential_distance(state, axis) * even * even / mean;
  Ripple columns;
  for (int n = 1; n <= highest_ripple; ++n) {
    const double c = std::cos(n * phase), s = std::sin(n * phase);
    columns(2 * n - 2) = (by_phase - n * n * by_curvature) * c - n * by_slope * s;
    columns(2 * n - 1) = (by_phase - n * n * by_curvature) * s + n * by_slope * c;
  }
  return columns;
}

// Normal equations of one section alone, with those of its ripple.
struct SectionNormal {
  Eigen::MatrixXd H, G;             // by the harmonics; by the ripple
  Eigen::MatrixXd cross, H_s, G_s;  // the same of the spline
  Eigen::VectorXd g, g_s;
};

void eliminate_spline(SectionNormal& one) {
  const Eigen::MatrixXd elimination = one.cross * positive_inverse(one.H_s);
  one.H -= elimination * one.cross.transpose();
  one.G -= elimination * one.G_s;
  one.g -= elimination * one.g_s;
}

std::vector<SectionNormal> section_normals(const RotationState& state) {
  const Index size = state.size();
  std::vector<SectionNormal> all;
  for (const PhaseSpline& spline : state.splines) {
    const Index knots = spline.c.size();
    all.push_back({Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, parts),
                   Eigen::MatrixXd::Zero(size, knots), Eigen::MatrixXd::Zero(knots, knots),
                   Eigen::MatrixXd::Zero(knots, parts), Eigen::VectorXd::Zero(size),
                   Eigen::VectorXd::Zero(knots)});
  }
  for_each_sample(state, [&](const RotationRecording& recording, const RotationSample& sample) {
    SectionNormal& one = all[sample.section];
    const Index knot = sample.local.first;
    for (std::size_t axis = 0; axis < state.axes; ++axis) {
      const AxisAt at = axis_at(state, axis, sample, recording.axes[axis][sample.k]);
      if (!std::isfinite(at.residual)) continue;
      const double weight = 1.0 / state.variance[axis];
      const Index from = harmonic_count * static_cast<Index>(axis);
      const Ripple ripple = weight * ripple_columns(state, axis, sample, at);
      const Harmonics columns = weight * at.columns;
      const Eigen::Vector4d basis = at.slope * sample.local.value;
      one.H.block<harmonic_count, harmonic_count>(from, from) += columns * at.columns.transpose();
      one.G.middleRows<harmonic_count>(from) += at.columns * ripple.transpose();
      one.g.segment<harmonic_count>(from) += at.residual * columns;
      one.cross.block<harmonic_count, 4>(from, knot) += columns * basis.transpose();
      one.H_s.block<4, 4>(knot, knot) += weight * basis * basis.transpose();
      one.G_s.middleRows<4>(knot) += basis * ripple.transpose();
      one.g_s.segment<4>(knot) += weight * at.residual * basis;
    }
  });
  for (SectionNormal& one : all) eliminate_spline(one);
  return all;
}

// H⁻¹ with zeros for what the section alone does not determine: the first axis's C1, the terms in
// the speed, and harmonics without a reading.
Eigen::MatrixXd section_inverse(Eigen::MatrixXd H) {
  std::vector<Index> out;
  for (Index k = 0; k < H.rows(); ++k) {
    const Index column = k % harmonic_count;
    if (k == 2 || column == square_speed_column || column == delay_column || !(H(k, k) > 0.0))
      out.push_back(k);
  }
  for (const Index k : out) {
    H.row(k).setZero();
    H.col(k).setZero();
    H(k, k) = 1.0;
  }
  Eigen::MatrixXd inverse = positive_inverse(H);
  for (const Index k : out) inverse(k, k) = 0.0;
  return inverse;
}

// Properties of a ripple n times a turn, in addition to its size.
struct RippleVerdict {
  SpeedRipple ripple;
  double sensor_bound = 0.0;  // of what the sensor may add where the ripple is accepted, 95 %
  // 95 % bound on a ripple that the sensor's own terms may cancel, where none is accepted.
  double hidden_bound = 0.0;
};

// 95 % bound of the sensor's own terms, as ripples, if one axis does not show them: K2 of 1 mg/g²
// is one of 0.1 % once a turn, K3 of 1 mg/g³ of 0.1 % twice a turn.
double usual_sensor_bound(int n) {
  constexpr double k2_g = 1e-3, k3_g2 = 1e-3;
  if (n > 2) return 0.0;
  return n == 1 ? k2_g : 0.5 * k3_g2;
}

// 95 % bound of a random term of the size of those in `seen`.
double bound_by(const Eigen::VectorXd& seen) {
  const auto n = static_cast<double>(seen.size());
  return student_t_quantile(0.975, n) * seen.norm() / std::sqrt(n);
}

RippleVerdict judge(int n,
                    const Ripple& ripple,
                    const Eigen::MatrixXd& covariance,
                    const Eigen::VectorXd& sensor,
                    double dof) {
  constexpr double beyond_chance = 0.01;
  const Eigen::Vector2d e = ripple.segment<2>(2 * n - 2);
  const Eigen::Matrix2d C = covariance.block<2, 2>(2 * n - 2, 2 * n - 2);
  RippleVerdict out{.ripple = {.per_turn = n}};
  out.ripple.chance_p = chance_of(e, C, dof);
  out.sensor_bound = sensor.size() > 0 ? bound_by(sensor) : e.norm();
  out.hidden_bound = sensor.size() > 0 ? out.sensor_bound : usual_sensor_bound(n);
  const bool alone = n > 2 || out.sensor_bound < 0.5 * e.norm();
  out.ripple.accepted = alone && out.ripple.chance_p < beyond_chance;
  // Δω/ω is the derivative of the phase's error by the phase: n times as large.
  const auto size = cross_axis_sensitivity(n * e, n * n * C, dof);
  if (size && out.ripple.accepted) out.ripple.amplitude = size->value;
  return out;
}

// ½ ε² S1, which moves the harmonics up to the third where a ripple was left with the sensor.
void add_second_order(double square, const RotationState& state, RotationEstimate& estimate) {
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const Index from = harmonic_count * static_cast<Index>(axis);
    for (Index k = 0; k < square_speed_column; ++k) {
      Eigen::VectorXd bound = Eigen::VectorXd::Zero(state.size());
      bound(from + k) = 0.5 * square * state.harmonics[axis](1);
      estimate.bounds.push_back(std::move(bound));
    }
  }
}

void add_radius_bounds(const Eigen::MatrixXd& by_radius, RotationEstimate& estimate) {
  for (Index k = 0; k < by_radius.cols(); ++k)
    estimate.bounds.push_back(normal_95 * assumed_radius_std_m * by_radius.col(k));
}

}  // namespace

std::vector<RippleSplit> split_ripples(const RotationState& state) {
  std::vector<RippleSplit> splits;
  const Eigen::VectorXd common = stacked(state), scale = scale_of(common);
  // Harmonics 0 and 1 are the sensor's, whatever the ripple.
  Eigen::VectorXd judging = Eigen::VectorXd::Zero(common.size());
  for (Index from = 0; from < common.size(); from += harmonic_count)
    for (int n = 2; n <= highest_harmonic; ++n)
      judging.segment<2>(from + sine_column(n)).setConstant(1.0 / scale(from));
  for (const SectionNormal& one : section_normals(state)) {
    const Eigen::MatrixXd inverse = section_inverse(one.H);
    Eigen::MatrixXd model(common.size(), state.axes == 2 ? parts + 3 : parts);
    model.leftCols(parts) = inverse * one.G;
    if (state.axes == 2) model.rightCols(3) = scale.asDiagonal() * sensor_terms();
    model = judging.asDiagonal() * model;
    const Eigen::MatrixXd rows =
        positive_inverse(model.transpose() * model) * model.transpose() * judging.asDiagonal();
    splits.push_back({common + inverse * one.g, rows.topRows(parts),
                      rows.bottomRows(rows.rows() - parts), rows.topRows(parts) * inverse, one.G});
  }
  return splits;
}

Eigen::MatrixXd ripple_by_radius(const RotationState& state,
                                 const Ripple& ripple,
                                 double gravity_mps2) {
  Eigen::MatrixXd effect = Eigen::MatrixXd::Zero(state.size(), 2);
  const double unit = state.mean_square_speed / gravity_mps2;  // r ω̄² in g, of 1 m
  for (int n = 1; n <= highest_ripple; ++n) {
    const Eigen::Vector2d e = ripple.segment<2>(2 * n - 2);
    // ω² = ω̄² (1 + 2 dε/dφ), φ̈ = ω̄² d²ε/dφ².
    const Eigen::Vector2d square = 2.0 * n * unit * Eigen::Vector2d(e(1), -e(0));
    const Eigen::Vector2d acceleration = -n * n * unit * e;
    add_harmonic(0, n, -square, effect.col(0));
    add_harmonic(0, n, -acceleration, effect.col(1));
    if (state.axes < 2) continue;
    add_harmonic(1, n, acceleration, effect.col(0));
    add_harmonic(1, n, -square, effect.col(1));
  }
  for (Index column = 0; column < 2; ++column)
    if (state.phase_defined) keep_phase(effect.col(column));
  for (std::size_t axis = 0; axis < state.axes; ++axis)
    effect.middleRows<harmonic_count>(harmonic_count * static_cast<Index>(axis)) *=
        state.harmonics[axis](1);
  return effect;
}

void measure_ripples(RotationState& state) {
  constexpr Index size = parts + 1;
  const std::size_t sections = state.sections.size();
  std::vector<Eigen::MatrixXd> H(sections, Eigen::MatrixXd::Zero(size, size));
  std::vector<Eigen::VectorXd> g(sections, Eigen::VectorXd::Zero(size));
  for_each_sample(state, [&](const RotationRecording&, const RotationSample& sample) {
    const double even =
        state.sense[sample.section] * state.splines[sample.section].value(sample.local);
    const double phase = state.offset[0] + state.direction * sample.theta;
    Eigen::VectorXd x(size);
    for (int n = 1; n <= highest_ripple; ++n) {
      x(2 * n - 2) = std::cos(n * phase);
      x(2 * n - 1) = std::sin(n * phase);
    }
    x(parts) = 1.0;
    H[sample.section] += x * x.transpose();
    g[sample.section] += state.direction * (sample.theta - even) * x;
  });
  for (std::size_t s = 0; s < sections; ++s)
    state.ripples[s] = (positive_inverse(H[s]) * g[s]).head<parts>();
}

bool fit_ripples(RotationState& state) {
  constexpr int most = 30, passes = 2;
  constexpr double still = 1e-9;
  for (int round = 0; round < most; ++round) {
    const std::vector<RippleSplit> splits = split_ripples(state);
    double largest = 0.0;
    for (std::size_t s = 0; s < splits.size(); ++s) {
      const Ripple more = splits[s].ripple_rows * splits[s].harmonics;
      if (!more.allFinite()) return false;
      state.ripples[s] += more;
      largest = std::max(largest, more.cwiseAbs().maxCoeff());
    }
    for (int k = 0; k < passes; ++k) step(state, true);
    if (largest < still) return true;
  }
  return false;
}

namespace {

// The sections' splits as one, for the harmonics that they have in common.
struct CommonSplit {
  Eigen::MatrixXd ripple_rows;    // by the common harmonics
  Eigen::MatrixXd moved;          // what a ripple of all sections does to them
  Eigen::MatrixXd ripple_scores;  // of the mean ripple
  Eigen::VectorXd sensor;
};

// Removes the ripples' part from the blocks' scores.
CommonSplit common_split(const RotationState& state,
                         const RotationSolver& solver,
                         RotationEstimate& estimate) {
  const std::vector<RippleSplit> splits = split_ripples(state);
  const std::vector<double> share = shares(state);
  BlockScores& blocks = estimate.blocks;
  CommonSplit common;
  const Index size = state.size();
  common.ripple_rows = Eigen::MatrixXd::Zero(parts, size);
  common.moved = Eigen::MatrixXd::Zero(size, parts);
  common.ripple_scores = Eigen::MatrixXd::Zero(parts, blocks.scores.cols());
  common.sensor = Eigen::VectorXd::Zero(splits.front().sensor_rows.rows());
  for (std::size_t s = 0; s < splits.size(); ++s) {
    common.ripple_rows += share[s] * splits[s].ripple_rows;
    common.moved += solver.inverse * splits[s].effect;
    common.sensor += share[s] * splits[s].sensor_rows * splits[s].harmonics;
  }
  for (Index b = 0; b < blocks.scores.cols(); ++b) {
    const std::size_t s = blocks.section[static_cast<std::size_t>(b)];
    const Eigen::VectorXd ripple = splits[s].by_gradient * blocks.gradients.col(b);
    blocks.scores.col(b) -= solver.inverse * (splits[s].effect * ripple);
    common.ripple_scores.col(b) = share[s] * ripple;
  }
  return common;
}

// The sensor's determined terms of the order of a ripple, with two axes.
Eigen::VectorXd seen_terms(int n, const RotationState& state, const Eigen::VectorXd& sensor) {
  if (state.axes < 2 || n > 2) return {};
  return n == 1 ? Eigen::VectorXd(sensor.head<2>()) : Eigen::VectorXd(sensor.tail<1>());
}

// Leaves a part of the ripple with the sensor, though it may be due to the ripple.
void leave_with_sensor(double mean,
                       double half_width,
                       const Eigen::VectorXd& moved,
                       const Eigen::RowVectorXd& scores,
                       RotationEstimate& estimate) {
  estimate.harmonics += mean * moved;
  estimate.blocks.scores += moved * scores;
  estimate.shared.push_back(half_width * moved);
}

}  // namespace

void separate_ripples(const RotationState& state,
                      const RotationSolver& solver,
                      const RotationOptions& options,
                      RotationEstimate& estimate,
                      RotationFit& fit) {
  const CommonSplit split = common_split(state, solver, estimate);
  const Eigen::MatrixXd& M = split.moved;
  const RippleMoments ripple = ripple_moments(state);
  const Eigen::MatrixXd covariance = estimate.covariance_of(split.ripple_scores);
  double left_square = 0.0;
  for (int n = 1; n <= highest_ripple; ++n) {
    const RippleVerdict verdict =
        judge(n, ripple.mean, covariance, seen_terms(n, state, split.sensor), estimate.dof());
    fit.ripples.push_back(verdict.ripple);
    for (const Index part : shared) {
      if (part / 2 != n - 1) continue;
      if (verdict.ripple.accepted) {
        estimate.bounds.push_back(verdict.sensor_bound * M.col(part));
        continue;
      }
      // What noise makes of it is in the scatter already: a third of its standard deviation is
      // what an interval can spare and still be one of 95 %.
      const double noise = 0.35 * std::sqrt(covariance(part, part));
      const double size = std::hypot(inexact * ripple.rms(part), verdict.hidden_bound);
      leave_with_sensor(ripple.mean(part), std::max(size - noise, 0.0), M.col(part),
                        split.ripple_scores.row(part), estimate);
      left_square += ripple.rms(part) * ripple.rms(part);
    }
  }
  add_second_order(left_square, state, estimate);
  if (state.speed_determined && state.axes == 2) return;
  const Eigen::MatrixXd by_radius = ripple_by_radius(state, ripple.rms, options.gravity_mps2);
  const Eigen::MatrixXd felt = by_radius - M * (split.ripple_rows * by_radius);
  // Two speeds determine the distance along the axis, not the one across it.
  add_radius_bounds(state.speed_determined ? felt.rightCols(1) : felt, estimate);
}

void allow_for_radius(const RotationState& state,
                      const RotationOptions& options,
                      RotationEstimate& estimate) {
  if (state.speed_determined) return;
  add_radius_bounds(ripple_by_radius(state, ripple_moments(state).mean, options.gravity_mps2),
                    estimate);
}

}  // namespace proofmass::calibrate
