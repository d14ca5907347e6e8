#include "proofmass/calibrate/rotation_ripple.hpp"

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
// Those that the sensor's terms are confounded with: once a turn cos and sin, twice a turn sin.
constexpr std::array<Index, 3> shared{0, 1, 3};
constexpr double normal_95 = 1.959964;

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

// The first axis's C1 is taken up by the phase, which turns the second with it.
void keep_phase(Eigen::Ref<Eigen::VectorXd> moved) {
  const double by = moved(2);
  for (Index from = 0; from < moved.size(); from += harmonic_count) moved(from + 2) -= by;
}

// E₁ = sin φ, E₂ = cos φ: what ε = cos nφ (part 0) or sin nφ (part 1) adds to them.
Eigen::VectorXd moved_by(std::size_t axes, int n, int part) {
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(harmonic_count * static_cast<Index>(axes));
  const auto half = [part](double sign) {
    return part == 0 ? Eigen::Vector2d(0.5 * sign, 0.0) : Eigen::Vector2d(0.0, 0.5 * sign);
  };
  // cos φ cos nφ = ½ (cos (n+1)φ + cos (n−1)φ), cos φ sin nφ the same with sines.
  add_harmonic(0, n + 1, half(1.0), moved);
  add_harmonic(0, n - 1, half(1.0), moved);
  if (axes == 2) {
    // −sin φ cos nφ = ½ (sin (n−1)φ − sin (n+1)φ), −sin φ sin nφ = ½ (cos (n+1)φ − cos (n−1)φ).
    const double sign = part == 0 ? 1.0 : -1.0;
    add_harmonic(1, n - 1, half(sign).reverse(), moved);
    add_harmonic(1, n + 1, -half(sign).reverse(), moved);
  }
  keep_phase(moved);
  return moved;
}

// The sensor's terms that a ripple does not imitate: q₁ − p₂, p₁ + q₂, t₁ + t₂ of 1.
Eigen::MatrixXd sensor_terms() {
  Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(2 * harmonic_count, 3);
  const Index p = sine_column(2), q = p + 1, t = sine_column(3), second = harmonic_count;
  terms(q, 0) = 0.5;
  terms(second + p, 0) = -0.5;
  terms(p, 1) = terms(second + q, 1) = 0.5;
  terms(t, 2) = terms(second + t, 2) = 0.5;
  return terms;
}

// Hotelling's T² of so many dimensions.
double chance_of(const Eigen::VectorXd& v, const Eigen::MatrixXd& C, double dof) {
  const auto dimensions = static_cast<double>(v.size());
  const double below = dof - dimensions + 1.0;
  if (below < 1.0 || !(C.trace() > 0.0)) return 1.0;
  const double squared = v.dot(positive_inverse(C) * v);
  return fisher_f_p(std::max(squared, 0.0) * below / (dimensions * dof), dimensions, below);
}

// Mean over the sections, by their turns.
Ripple mean_ripple(const RotationState& state) {
  Ripple sum = Ripple::Zero();
  double turns = 0.0;
  for (std::size_t s = 0; s < state.sections.size(); ++s) {
    const auto n = static_cast<double>(state.sections[s].turn_s.size());
    sum += n * state.ripples[s];
    turns += n;
  }
  return sum / turns;
}

// All axes' harmonics, one behind the other.
Eigen::VectorXd stacked(const RotationState& state) {
  Eigen::VectorXd all(state.size());
  for (std::size_t axis = 0; axis < state.axes; ++axis)
    all.segment<harmonic_count>(harmonic_count * static_cast<Index>(axis)) = state.harmonics[axis];
  return all;
}

// What the residuals of each section add to the common harmonics.
std::vector<Eigen::VectorXd> section_harmonics(const RotationState& state) {
  const Index size = state.size();
  std::vector<Eigen::VectorXd> found(state.sections.size(), stacked(state));
  if (found.size() == 1) return found;
  std::vector<Eigen::MatrixXd> H(found.size(), Eigen::MatrixXd::Zero(size, size));
  std::vector<Eigen::VectorXd> g(found.size(), Eigen::VectorXd::Zero(size));
  for_each_sample(state, [&](const RotationRecording& recording, const RotationSample& sample) {
    for (std::size_t axis = 0; axis < state.axes; ++axis) {
      AxisAt at = axis_at(state, axis, sample, recording.axes[axis][sample.k]);
      if (!std::isfinite(at.residual)) continue;
      at.columns(square_speed_column) = at.columns(delay_column) = 0.0;
      const Index from = harmonic_count * static_cast<Index>(axis);
      H[sample.section].block<harmonic_count, harmonic_count>(from, from) +=
          at.columns * at.columns.transpose();
      g[sample.section].segment<harmonic_count>(from) += at.residual * at.columns;
    }
  });
  for (std::size_t s = 0; s < found.size(); ++s) {
    for (Index k = 0; k < size; ++k)
      if (H[s](k, k) == 0.0) H[s](k, k) = 1.0;
    found[s] += positive_inverse(H[s]) * g[s];
  }
  return found;
}

// What is known of a ripple n times a turn beside its size.
struct RippleVerdict {
  SpeedRipple ripple;
  double sensor_bound = 0.0;  // of what the sensor may add where the ripple is accepted, 95 %
};

// 95 % bound of a term that is as large as `seen` were, at random.
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

RippleSplit::RippleSplit(std::size_t axes) : axes_(axes) {
  const Index size = harmonic_count * static_cast<Index>(axes);
  moved_ = Eigen::MatrixXd::Zero(size, parts);
  for (int n = 1; n <= highest_ripple; ++n)
    for (int part = 0; part < 2; ++part) moved_.col(2 * n - 2 + part) = moved_by(axes, n, part);
  Eigen::MatrixXd model(size, axes == 2 ? parts + 3 : parts);
  model.leftCols(parts) = moved_;
  if (axes == 2) model.rightCols(3) = sensor_terms();
  // Harmonics 0 and 1 are the sensor's, whatever the ripple.
  Eigen::VectorXd judging = Eigen::VectorXd::Zero(size);
  for (Index from = 0; from < size; from += harmonic_count)
    for (int n = 2; n <= highest_harmonic; ++n) judging.segment<2>(from + sine_column(n)).setOnes();
  model = judging.asDiagonal() * model;
  rows_ = positive_inverse(model.transpose() * model) * model.transpose();
}

Eigen::VectorXd RippleSplit::scale(const Eigen::VectorXd& harmonics) const {
  Eigen::VectorXd scale(harmonics.size());
  for (Index from = 0; from < harmonics.size(); from += harmonic_count)
    scale.segment<harmonic_count>(from).setConstant(harmonics(from + 1));
  return scale;
}

Eigen::MatrixXd RippleSplit::ripple_rows(const Eigen::VectorXd& harmonics) const {
  return rows_.topRows(parts) * scale(harmonics).cwiseInverse().asDiagonal();
}

Eigen::MatrixXd RippleSplit::sensor_rows(const Eigen::VectorXd& harmonics) const {
  if (axes_ < 2) return Eigen::MatrixXd::Zero(3, harmonics.size());
  return rows_.bottomRows(3) * scale(harmonics).cwiseInverse().asDiagonal();
}

Ripple RippleSplit::ripple(const Eigen::VectorXd& harmonics) const {
  return ripple_rows(harmonics) * harmonics;
}

Eigen::Vector3d RippleSplit::sensor(const Eigen::VectorXd& harmonics) const {
  return sensor_rows(harmonics) * harmonics;
}

Eigen::MatrixXd RippleSplit::moved(const Eigen::VectorXd& harmonics) const {
  return scale(harmonics).asDiagonal() * moved_;
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

void fit_ripples(RotationState& state) {
  constexpr int most = 12, passes = 3;
  constexpr double still = 1e-9;
  const RippleSplit split(state.axes);
  for (int round = 0; round < most; ++round) {
    const std::vector<Eigen::VectorXd> harmonics = section_harmonics(state);
    double largest = 0.0;
    for (std::size_t s = 0; s < harmonics.size(); ++s) {
      const Ripple more = split.ripple(harmonics[s]);
      if (!more.allFinite()) return;
      state.ripples[s] += more;
      largest = std::max(largest, more.cwiseAbs().maxCoeff());
    }
    for (int k = 0; k < passes; ++k) step(state, true);
    if (largest < still) return;
  }
}

void separate_ripples(const RotationState& state,
                      const RotationOptions& options,
                      RotationEstimate& estimate,
                      RotationFit& fit) {
  const RippleSplit split(state.axes);
  const Eigen::VectorXd h = estimate.harmonics;
  const Eigen::MatrixXd P = split.ripple_rows(h), M = split.moved(h), S = split.sensor_rows(h);
  const Ripple ripple = mean_ripple(state) + split.ripple(h);
  const Eigen::MatrixXd covariance = P * estimate.covariance() * P.transpose();
  const Eigen::Vector3d sensor = S * h;
  const double dof = estimate.dof();
  const Eigen::MatrixXd L = Eigen::MatrixXd::Identity(h.size(), h.size()) - M * P;
  const Eigen::MatrixXd ripple_scores = P * estimate.blocks.scores;
  estimate.harmonics = L * h;
  estimate.blocks.scores = L * estimate.blocks.scores;
  constexpr double inexact = 1.05;  // the model of first order holds to a few per cent
  double left_square = 0.0;
  for (int n = 1; n <= highest_ripple; ++n) {
    Eigen::VectorXd seen;
    if (state.axes == 2 && n == 1) seen = sensor.head<2>();
    if (state.axes == 2 && n == 2) seen = sensor.tail<1>();
    const RippleVerdict verdict = judge(n, ripple, covariance, seen, dof);
    fit.ripples.push_back(verdict.ripple);
    for (const Index part : shared) {
      if (part / 2 != n - 1) continue;
      if (verdict.ripple.accepted) {
        estimate.bounds.push_back(verdict.sensor_bound * M.col(part));
        continue;
      }
      // Left with the sensor, though it may be the ripple's.
      estimate.harmonics += ripple(part) * M.col(part);
      estimate.blocks.scores += M.col(part) * ripple_scores.row(part);
      // What noise makes of it is in the scatter already: a third of its standard deviation is
      // what an interval can spare and still be one of 95 %.
      const double noise = 0.35 * std::sqrt(covariance(part, part));
      estimate.shared.push_back(std::max(inexact * std::abs(ripple(part)) - noise, 0.0) *
                                M.col(part));
      left_square += ripple(part) * ripple(part);
    }
  }
  add_second_order(left_square, state, estimate);
  if (state.speed_told) return;
  add_radius_bounds(L * ripple_by_radius(state, ripple, options.gravity_mps2), estimate);
}

void allow_for_radius(const RotationState& state,
                      const RotationOptions& options,
                      RotationEstimate& estimate) {
  if (state.speed_told) return;
  add_radius_bounds(ripple_by_radius(state, mean_ripple(state), options.gravity_mps2), estimate);
}

}  // namespace proofmass::calibrate
