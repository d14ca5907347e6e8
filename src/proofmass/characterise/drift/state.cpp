#include "proofmass/characterise/drift/state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "proofmass/characterise/drift/shapes.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::array<Term, 3> slow_terms{Term::random_walk, Term::flicker, Term::markov};
constexpr Index terms = 3;

// Density of each drift term at each ordinate, k = 0 first. There a random walk has none, as it is
// counted from its own mean over the record until pinned; the others' are those of half the lowest
// frequency.
MatrixXd slow_noise_densities(const DriftEvidence& evidence, const DriftFitAtShape& trial) {
  MatrixXd S = MatrixXd::Zero(evidence.blocks(), terms);
  for (std::size_t k = 0; k < trial.noise.terms.size(); ++k) {
    const auto column = static_cast<Index>(k);
    for (Index j = 0; j < terms; ++j) {
      const Term term = slow_terms[static_cast<std::size_t>(j)];
      if (trial.noise.terms[k] != term) continue;
      S.col(j).tail(evidence.blocks() - 1) = trial.noise.P.col(column) * trial.fit.strength(column);
      if (term == Term::flicker) S(0, j) = 2.0 * S(1, j);
      if (term == Term::markov) S(0, j) = S(1, j);
    }
  }
  return S;
}

// As curve_jacobian: [amplitudes; ln τ], then the missing blocks.
MatrixXd rival_jacobian(const DriftEvidence& evidence,
                        const DriftFitAtShape& trial,
                        const MatrixXd& columns) {
  if (trial.at.log_times.empty()) return columns;
  const auto own = static_cast<Index>(amplitudes_of(trial.at.shape));
  MatrixXd J(evidence.blocks(), columns.cols() + 1);
  J << columns.leftCols(own),
      rival_by_log_scale(evidence, trial.at, trial.fit.coefficients.head(own)),
      columns.rightCols(columns.cols() - own);
  return J;
}

// Derivatives of the mean's ordinates, k = 0 first, by the parameters of the curve's covariance,
// without the level, and then by the missing blocks.
MatrixXd curve_jacobian(const DriftEvidence& evidence, const DriftFitAtShape& trial) {
  const MatrixXd columns = whole_columns(evidence, trial.at);
  if (is_rival(trial.at.shape)) return rival_jacobian(evidence, trial, columns);
  const auto exponentials = static_cast<Index>(trial.at.log_times.size());
  MatrixXd J(evidence.blocks(), columns.cols() + exponentials);
  for (Index k = 0; k < exponentials; ++k) {
    const double T = std::exp(trial.at.log_times[static_cast<std::size_t>(k)]);
    J.col(2 * k) = columns.col(k);
    J.col(2 * k + 1) = trial.fit.coefficients(k) * evidence.rise_by_log_time(T);
  }
  J.rightCols(columns.cols() - exponentials) = columns.rightCols(columns.cols() - exponentials);
  return J;
}

// How many of them belong to the curve.
Index curve_parameters(const DriftEvidence& evidence, const MatrixXd& J) {
  return J.cols() - evidence.dummies().cols();
}

// Linear functionals of the data and their errors: level (the mean of the record), walk at t = 0,
// and each term at the end.
struct Functionals {
  VectorXd value;
  MatrixXd covariance;   // given the curve
  MatrixXd sensitivity;  // to the curve's parameters and missing blocks
};

Functionals functionals(const DriftEvidence& evidence,
                        const DriftFitAtShape& trial,
                        const MatrixXd& J,
                        const VectorXd& residual) {
  const Index rest = evidence.blocks() - 1;
  constexpr Index count = 2 + terms;  // level, walk at the start, terms at the end
  const MatrixXd S = slow_noise_densities(evidence, trial);
  const VectorXd start = evidence.at(evidence.start_s()), end = evidence.at(evidence.end_s());
  Functionals out{VectorXd::Zero(count), MatrixXd::Zero(count, count),
                  MatrixXd::Zero(count, J.cols())};
  // Level: the residual at k = 0, which also contains the stationary terms' means.
  const double to_level = start(0), white = trial.noise.strength(trial.fit, Term::white);
  out.value(0) = to_level * residual(0);
  out.covariance(0, 0) = to_level * to_level * (white * white + S.row(0).sum());
  out.sensitivity.row(0) = -to_level * J.row(0);
  for (Index j = 1; j < terms; ++j) {
    out.covariance(0, 2 + j) = out.covariance(2 + j, 0) = -to_level * end(0) * S(0, j);
    out.covariance(2 + j, 2 + j) = end(0) * end(0) * S(0, j);
  }
  // All others at k ≥ 1: weight and density of each, and its estimate.
  MatrixXd weight(rest, count - 1), weighted(rest, count - 1);
  weight << start.tail(rest), end.tail(rest).replicate(1, terms);
  weighted << S.col(0).tail(rest), S.bottomRows(rest);
  weighted = weighted.cwiseProduct(weight).eval();
  const MatrixXd gain = trial.fit.density.cwiseInverse().asDiagonal() * weighted;
  out.value.tail(count - 1) = gain.transpose() * residual.tail(rest);
  out.sensitivity.bottomRows(count - 1) = -gain.transpose() * J.bottomRows(rest);
  auto own = out.covariance.bottomRightCorner(count - 1, count - 1);
  own -= gain.transpose() * weighted;
  for (Index a = 0; a + 1 < count; ++a) own(a, a) += weight.col(a).dot(weighted.col(a));
  const double walk = weight.col(0).dot(weighted.col(1));  // at its two ends
  own(0, 1) += walk;
  own(1, 0) += walk;
  return out;
}

// The random walk before the recording, and the change of each term between the last block's mean
// and its end: ∫∫ of the increments is K² h/3 for a random walk, as for a Markov process slower
// than a block.
void add_unseen(const DriftEvidence& evidence, const DriftFitAtShape& trial, MatrixXd& of_values) {
  const DriftNoise noise = noise_of(trial);
  const double third = evidence.block_s() / 3.0, K = noise.random_walk;
  const double start = K * K * std::max(0.0, evidence.start_s() + third);
  of_values(0, 0) += start;
  of_values(0, 1) -= start;
  of_values(1, 0) -= start;
  of_values(1, 1) += start + K * K * third;
  of_values(2, 2) += 2.0 * std::numbers::ln2 / std::numbers::pi * noise.flicker * noise.flicker;
  of_values(3, 3) +=
      std::min(noise.markov * noise.markov * third, noise.markov_std() * noise.markov_std());
}

void fill_curve(const DriftEvidence& evidence,
                const DriftFitAtShape& trial,
                const MatrixXd& covariance,
                DriftCurve& curve) {
  const VectorXd& b = trial.fit.coefficients;
  const std::vector<double>& log_times = trial.at.log_times;
  curve.shape = trial.at.shape;
  const auto varying = static_cast<Index>(amplitudes_of(curve.shape));
  if (varying > 0) curve.a1 = b(0);
  if (varying > 1) curve.second_a1 = b(1);
  if (!log_times.empty()) curve.time_constant_s = std::exp(log_times[0]);
  if (log_times.size() > 1) curve.second_time_constant_s = std::exp(log_times[1]);
  Index place = varying;
  if (curve.shape == DriftShape::line || curve.shape == DriftShape::exponential_and_line)
    curve.slope_per_s = b(place++) / evidence.duration_s();
  Index entry = covariance.rows() - static_cast<Index>(trial.at.step_blocks.size());
  for (const std::size_t block : trial.at.step_blocks)
    curve.steps.push_back({evidence.start_s() + static_cast<double>(block) * evidence.block_s(),
                           {b(place++), std::sqrt(covariance(entry, entry))}}),
        ++entry;
}

}  // namespace

DriftNoise noise_of(const DriftFitAtShape& trial) {
  return {trial.noise.strength(trial.fit, Term::white),
          trial.noise.strength(trial.fit, Term::flicker),
          trial.noise.strength(trial.fit, Term::random_walk),
          trial.noise.strength(trial.fit, Term::markov), trial.noise.markov_time_constant_s};
}

PlacedCurve place(const DriftEvidence& evidence, const DriftFitAtShape& trial) {
  const Index n = evidence.blocks();
  MatrixXd J = curve_jacobian(evidence, trial);
  const Index own = curve_parameters(evidence, J);
  // The line's column is of t/duration, the covariance of the slope.
  VectorXd scale = VectorXd::Ones(J.cols());
  if (trial.at.shape == DriftShape::line || trial.at.shape == DriftShape::exponential_and_line)
    scale(2 * static_cast<Index>(trial.at.log_times.size())) = 1.0 / evidence.duration_s();
  const VectorXd residual =
      evidence.ordinates() - whole_columns(evidence, trial.at) * trial.fit.coefficients;
  const MatrixXd rows = J.bottomRows(n - 1);
  const MatrixXd of_curve =
      J.cols() > 0 ? positive_inverse(rows.transpose() *
                                      (trial.fit.density.cwiseInverse().asDiagonal() * rows))
                   : MatrixXd(0, 0);
  const Functionals found = functionals(evidence, trial, J, residual);
  // [a2; slow noise since 0]: level less the walk since 0, and the walk's end less its start.
  MatrixXd turn = MatrixXd::Zero(1 + terms, found.value.size());
  turn(0, 0) = turn(0, 1) = 1.0;
  turn(1, 1) = -1.0;
  turn(1, 2) = turn(2, 3) = turn(3, 4) = 1.0;
  const VectorXd value = turn * found.value;
  const MatrixXd sensitivity = turn * found.sensitivity;
  MatrixXd of_values =
      turn * found.covariance * turn.transpose() + sensitivity * of_curve * sensitivity.transpose();
  add_unseen(evidence, trial, of_values);
  const MatrixXd cross = (of_curve * sensitivity.transpose());  // curve by [a2; slow noise]

  PlacedCurve placed;
  MatrixXd all(1 + own + terms, 1 + own + terms);
  const VectorXd own_scale = scale.head(own);
  all(0, 0) = of_values(0, 0);
  all.block(1, 1, own, own) =
      own_scale.asDiagonal() * of_curve.topLeftCorner(own, own) * own_scale.asDiagonal();
  all.block(1, 0, own, 1) = own_scale.asDiagonal() * cross.topRows(own).col(0);
  all.block(0, 1, 1, own) = all.block(1, 0, own, 1).transpose();
  all.block(1 + own, 1 + own, terms, terms) = of_values.bottomRightCorner(terms, terms);
  all.block(1 + own, 0, terms, 1) = of_values.block(1, 0, terms, 1);
  all.block(0, 1 + own, 1, terms) = of_values.block(0, 1, 1, terms);
  all.block(1, 1 + own, own, terms) = own_scale.asDiagonal() * cross.topRows(own).rightCols(terms);
  all.block(1 + own, 1, terms, own) = all.block(1, 1 + own, own, terms).transpose();
  placed.curve.covariance = all.topLeftCorner(1 + own, 1 + own);
  placed.curve.a2 = value(0);
  fill_curve(evidence, trial, placed.curve.covariance, placed.curve);
  placed.end = {evidence.end_s(), value.tail(terms), all};
  return placed;
}

}  // namespace proofmass::characterise
