#include "proofmass/characterise/drift/fit_at_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/characterise/drift/shapes.hpp"
#include "proofmass/characterise/drift/step_search.hpp"
#include "proofmass/fit/variable_projection.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_rounds = 12;
constexpr double settled = 1e-3;  // in ln T: a tenth of what any recording determines
constexpr std::size_t most_steps = 32;

// Range of a scale: a logarithm with a τ below a block is ln t, and a sine with more than two
// periods in the record does not resemble a warm-up.
TimeRange scale_range(const DriftEvidence& evidence, DriftShape shape) {
  if (is_exponential(shape)) return time_range(evidence);
  const double record_s = evidence.duration_s();
  if (shape == DriftShape::sine) return {0.5 * record_s, 8.0 * record_s};
  return {0.25 * evidence.block_s(), 10.0 * record_s};
}

// Columns that depend on the scales, at these scales; of two exponentials the first alone while the
// second is not yet started.
MatrixXd varying_columns(const DriftEvidence& evidence, DriftShape shape, View<double> log_times) {
  const std::size_t count = is_exponential(shape) ? log_times.size() : amplitudes_of(shape);
  MatrixXd columns(evidence.blocks(), static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const auto column = static_cast<Index>(k);
    if (is_exponential(shape)) {
      columns.col(column) = evidence.rise(std::exp(log_times[k]));
      continue;
    }
    const RivalColumn rival{shape, k, log_times.empty() ? 1.0 : std::exp(log_times.front())};
    columns.col(column) = evidence.of([&](double t_s) { return rival.at(t_s); });
  }
  return columns;
}

// Linear columns independent of the time constants.
MatrixXd fixed_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  const Index line = has_line(at.shape) ? 1 : 0, steps = static_cast<Index>(at.step_blocks.size());
  MatrixXd columns(evidence.blocks(), line + steps + evidence.dummies().cols());
  if (line > 0) columns.col(0) = evidence.line();
  for (Index k = 0; k < steps; ++k)
    columns.col(line + k) = evidence.step(at.step_blocks[static_cast<std::size_t>(k)]);
  columns.rightCols(evidence.dummies().cols()) = evidence.dummies();
  return columns;
}

MatrixXd beside(const MatrixXd& left, const MatrixXd& right) {
  MatrixXd both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

// The best-fitting time constants for noise of density S.
std::vector<double> best_times(const DriftEvidence& evidence,
                               const ShapeAt& at,
                               const VectorXd& S) {
  const Index rows = evidence.blocks() - 1;
  const VectorXd root = S.cwiseSqrt().cwiseInverse();
  const VectorXd y = root.cwiseProduct(evidence.contrasts());
  const TimeRange range = scale_range(evidence, at.shape);
  fit::SeparableProblem problem;
  problem.basis = [&](View<double> log_times, Eigen::Ref<MatrixXd> columns) {
    columns = root.asDiagonal() * varying_columns(evidence, at.shape, log_times).bottomRows(rows);
  };
  problem.varying_columns = static_cast<Index>(amplitudes_of(at.shape));
  problem.start = at.log_times;
  problem.lower.assign(at.log_times.size(), std::log(range.lower_s));
  problem.upper.assign(at.log_times.size(), std::log(range.upper_s));
  const MatrixXd fixed = fixed_columns(evidence, at).bottomRows(rows);
  if (fixed.cols() > 0) problem.constant = fit::factor_columns(root.asDiagonal() * fixed);
  const auto found = fit::fit_separable({y.data(), static_cast<std::size_t>(y.size())}, problem,
                                        {.unit_variance = true, .search_again = false});
  return found ? found->alpha : at.log_times;
}

// Alternates noise and time constants until convergence.
OrdinateFit settle(const DriftEvidence& evidence, ShapeAt& at, const MatrixXd& P, OrdinateFit fit) {
  for (int round = 0; round < most_rounds; ++round) {
    fit = fit_ordinates(evidence.contrasts(), P, restricted(evidence, at), fit.strength);
    // A shape that is a line within rounding leaves no density for weights.
    const bool is_fitted = fit.density.allFinite() && fit.density.minCoeff() > 0.0;
    if (at.log_times.empty() || !is_fitted) break;
    const std::vector<double> times = best_times(evidence, at, fit.density);
    double moved = 0.0;
    for (std::size_t k = 0; k < times.size(); ++k)
      moved = std::max(moved, std::abs(times[k] - at.log_times[k]));
    at.log_times = times;
    if (moved < settled) break;
  }
  return fit_ordinates(evidence.contrasts(), P, restricted(evidence, at), fit.strength);
}

// The most likely of a grid of time constants; for two, the second in addition to the best single
// one.
void start_times(const DriftEvidence& evidence, const MatrixXd& P, ShapeAt& at) {
  const std::size_t wanted = scales_of(at.shape);
  constexpr std::size_t points = 14;
  const TimeRange range = scale_range(evidence, at.shape);
  const bool rival = is_rival(at.shape);
  const double low = std::log((rival ? 1.0 : 2.0) * range.lower_s);
  const double high = std::log((rival ? 1.0 : 0.3) * range.upper_s);
  while (at.log_times.size() < wanted) {
    double best = -std::numeric_limits<double>::infinity(), best_time = low;
    VectorXd strength;
    at.log_times.push_back(low);
    for (std::size_t k = 0; k < points; ++k) {
      at.log_times.back() =
          low + (high - low) * static_cast<double>(k) / static_cast<double>(points - 1);
      const OrdinateMeans means{linear_columns(evidence, at), {}, evidence.missing()};
      const OrdinateFit fit = fit_ordinates(evidence.contrasts(), P, means, strength);
      strength = fit.strength;
      if (fit.log_likelihood <= best) continue;
      best = fit.log_likelihood;
      best_time = at.log_times.back();
    }
    at.log_times.back() = best_time;
  }
}

void add_steps(const DriftEvidence& evidence, ShapeAt& at, const MatrixXd& P, OrdinateFit& fit) {
  const double least_gain = 3.0 * std::log(static_cast<double>(evidence.blocks()));
  while (at.step_blocks.size() < most_steps) {
    const OrdinateMeans means = restricted(evidence, at);
    const FoundStep step = find_step(evidence, means.fitted, fit.density);
    if (step.gain < least_gain) return;
    at.step_blocks.push_back(step.block);
    std::ranges::sort(at.step_blocks);
    fit = fit_ordinates(evidence.contrasts(), P, restricted(evidence, at), fit.strength);
  }
}

// By the likelihood itself. White noise and a random walk are part of every shape, so that no shape
// is preferred for the lack of a random walk; further terms only if they are significant.
DriftCandidate candidate_of(const DriftEvidence& evidence,
                            const NoiseChoice& choice,
                            const DriftFitAtShape& trial) {
  DriftCandidate candidate;
  candidate.shape = trial.at.shape;
  candidate.steps = trial.at.step_blocks.size();
  if (!trial.at.log_times.empty()) candidate.time_constant_s = std::exp(trial.at.log_times.front());
  // The position of a step counts as a parameter too.
  const std::size_t varying = amplitudes_of(trial.at.shape) + trial.at.log_times.size();
  const int of_shape =
      1 + static_cast<int>(varying + 2 * candidate.steps) + (has_line(trial.at.shape) ? 1 : 0);
  const double cost = std::log(static_cast<double>(evidence.blocks()) -
                               static_cast<double>(evidence.missing().size()));
  const OrdinateMeans means{linear_columns(evidence, trial.at), {}, evidence.missing()};
  candidate.information_criterion = std::numeric_limits<double>::infinity();
  for (const NoiseColumns& noise : {choice.base(), choice.with_base(trial.noise)}) {
    const double found = fit_ordinates(evidence.contrasts(), noise.P, means).log_likelihood;
    const int parameters = of_shape + noise.parameters();
    const double criterion = -2.0 * found + parameters * cost;
    if (!(criterion < candidate.information_criterion)) continue;
    candidate.parameters = parameters;
    candidate.log_likelihood = found;
    candidate.information_criterion = criterion;
  }
  return candidate;
}

// The larger of two exponentials comes first.
void put_in_order(DriftFitAtShape& trial) {
  if (trial.at.shape != DriftShape::two_exponentials) return;
  VectorXd& b = trial.fit.coefficients;
  if (std::abs(b(0)) >= std::abs(b(1))) return;
  std::swap(trial.at.log_times[0], trial.at.log_times[1]);
  std::swap(b(0), b(1));
  trial.fit.covariance.row(0).swap(trial.fit.covariance.row(1));
  trial.fit.covariance.col(0).swap(trial.fit.covariance.col(1));
}

}  // namespace

TimeRange time_range(const DriftEvidence& evidence) {
  // In a short table each value counts: half of it may be settled.
  constexpr double most_blocks = 2.0, share = 1.0 / 30.0;
  const double blocks = std::min(most_blocks, share * static_cast<double>(evidence.blocks()));
  return {blocks * evidence.block_s(), 10.0 * evidence.duration_s()};
}

MatrixXd whole_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  return beside(varying_columns(evidence, at.shape, at.log_times), fixed_columns(evidence, at));
}

MatrixXd linear_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  return whole_columns(evidence, at).bottomRows(evidence.blocks() - 1);
}

MatrixXd tangent_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  const Index rows = evidence.blocks() - 1;
  const std::size_t scales = scales_of(at.shape), amplitudes = amplitudes_of(at.shape);
  MatrixXd tangents(rows, static_cast<Index>(scales > 0 ? amplitudes : 0));
  for (std::size_t k = 0; k < amplitudes && scales > 0; ++k) {
    const VectorXd tangent = is_exponential(at.shape)
                                 ? evidence.rise_by_log_time(std::exp(at.log_times[k]))
                                 : rival_by_log_scale(evidence, at,
                                                      VectorXd::Unit(static_cast<Index>(amplitudes),
                                                                     static_cast<Index>(k)));
    tangents.col(static_cast<Index>(k)) = tangent.tail(rows);
  }
  const MatrixXd linear = linear_columns(evidence, at);
  const Index own = linear.cols() - evidence.dummies().cols();
  MatrixXd columns(rows, linear.cols() + tangents.cols());
  columns << linear.leftCols(own), tangents, evidence.dummies().bottomRows(rows);
  return columns;
}

OrdinateMeans restricted(const DriftEvidence& evidence, const ShapeAt& at) {
  return {linear_columns(evidence, at), tangent_columns(evidence, at), evidence.missing()};
}

VectorXd rival_by_log_scale(const DriftEvidence& evidence,
                            const ShapeAt& at,
                            const VectorXd& amplitudes) {
  const double scale_s = std::exp(at.log_times.front());
  return evidence.of([&](double t_s) {
    double slope = 0.0;
    for (Index k = 0; k < amplitudes.size(); ++k)
      slope += amplitudes(k) *
               RivalColumn{at.shape, static_cast<std::size_t>(k), scale_s}.by_log_scale(t_s);
    return slope;
  });
}

DriftFitAtShape try_shape(const DriftEvidence& evidence,
                          const NoiseChoice& choice,
                          DriftShape shape) {
  DriftFitAtShape trial;
  trial.at.shape = shape;
  trial.noise = choice.base();
  start_times(evidence, trial.noise.P, trial.at);
  trial.fit = fit_ordinates(evidence.contrasts(), trial.noise.P, restricted(evidence, trial.at));
  constexpr int choices = 2;
  for (int k = 0; k < choices; ++k) {
    if (shape == DriftShape::steps) add_steps(evidence, trial.at, trial.noise.P, trial.fit);
    trial.fit = settle(evidence, trial.at, trial.noise.P, std::move(trial.fit));
    trial.noise = choice.choose(evidence.contrasts(), restricted(evidence, trial.at));
    trial.fit = fit_ordinates(evidence.contrasts(), trial.noise.P, restricted(evidence, trial.at));
  }
  trial.fit = settle(evidence, trial.at, trial.noise.P, std::move(trial.fit));
  put_in_order(trial);
  trial.candidate = candidate_of(evidence, choice, trial);
  return trial;
}

}  // namespace proofmass::characterise
