#include "proofmass/characterise/drift_trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/characterise/step_search.hpp"
#include "proofmass/fit/variable_projection.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_rounds = 12;
constexpr double settled = 1e-3;  // in ln T: a tenth of what any recording can tell
constexpr std::size_t most_steps = 32;

std::size_t exponentials_of(DriftShape shape) {
  if (shape == DriftShape::two_exponentials) return 2;
  return shape == DriftShape::exponential || shape == DriftShape::exponential_and_line ? 1 : 0;
}

// Linear columns that no time constant moves.
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

OrdinateMeans restricted(const DriftEvidence& evidence, const ShapeAt& at) {
  return {linear_columns(evidence, at), tangent_columns(evidence, at)};
}

// The time constants that fit best where the noise has the density S.
std::vector<double> best_times(const DriftEvidence& evidence,
                               const ShapeAt& at,
                               const VectorXd& S) {
  const Index rows = evidence.blocks() - 1;
  const VectorXd root = S.cwiseSqrt().cwiseInverse();
  const VectorXd y = root.cwiseProduct(evidence.contrasts());
  const TimeRange range = time_range(evidence);
  fit::SeparableProblem problem;
  problem.basis = [&](View<double> log_times, Eigen::Ref<MatrixXd> columns) {
    for (std::size_t k = 0; k < log_times.size(); ++k)
      columns.col(static_cast<Index>(k)) =
          root.cwiseProduct(evidence.rise(std::exp(log_times[k])).tail(rows));
  };
  problem.varying_columns = static_cast<Index>(at.log_times.size());
  problem.start = at.log_times;
  problem.lower.assign(at.log_times.size(), std::log(range.lower_s));
  problem.upper.assign(at.log_times.size(), std::log(range.upper_s));
  const MatrixXd fixed = fixed_columns(evidence, at).bottomRows(rows);
  if (fixed.cols() > 0) problem.constant = fit::factor_columns(root.asDiagonal() * fixed);
  const auto found = fit::fit_separable({y.data(), static_cast<std::size_t>(y.size())}, problem,
                                        {.unit_variance = true, .search_again = false});
  return found ? found->alpha : at.log_times;
}

// Noise and time constants in turn until neither moves.
OrdinateFit settle(const DriftEvidence& evidence, ShapeAt& at, const MatrixXd& P, OrdinateFit fit) {
  for (int round = 0; round < most_rounds; ++round) {
    fit = fit_ordinates(evidence.contrasts(), P, restricted(evidence, at), fit.strength);
    if (at.log_times.empty()) break;
    const std::vector<double> times = best_times(evidence, at, fit.density);
    double moved = 0.0;
    for (std::size_t k = 0; k < times.size(); ++k)
      moved = std::max(moved, std::abs(times[k] - at.log_times[k]));
    at.log_times = times;
    if (moved < settled) break;
  }
  return fit_ordinates(evidence.contrasts(), P, restricted(evidence, at), fit.strength);
}

// The most likely of a grid of time constants; of two, the second beside the best single one.
void start_times(const DriftEvidence& evidence, const MatrixXd& P, ShapeAt& at) {
  const std::size_t wanted = exponentials_of(at.shape);
  constexpr std::size_t points = 14;
  const TimeRange range = time_range(evidence);
  const double low = std::log(2.0 * range.lower_s), high = std::log(0.3 * range.upper_s);
  while (at.log_times.size() < wanted) {
    double best = -std::numeric_limits<double>::infinity(), best_time = low;
    VectorXd strength;
    at.log_times.push_back(low);
    for (std::size_t k = 0; k < points; ++k) {
      at.log_times.back() =
          low + (high - low) * static_cast<double>(k) / static_cast<double>(points - 1);
      const OrdinateMeans means{linear_columns(evidence, at), {}};
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

// By the likelihood itself. White noise and a random walk stand beside every shape, so that no
// shape is preferred for doing without the walk; more than these only where they pay for
// themselves.
DriftCandidate candidate_of(const DriftEvidence& evidence,
                            const NoiseChoice& choice,
                            const DriftTrial& trial) {
  DriftCandidate candidate;
  candidate.shape = trial.at.shape;
  candidate.steps = trial.at.step_blocks.size();
  if (!trial.at.log_times.empty()) candidate.time_constant_s = std::exp(trial.at.log_times.front());
  // Of a step its place counts too.
  const int of_shape = 1 + static_cast<int>(2 * trial.at.log_times.size() + 2 * candidate.steps) +
                       (has_line(trial.at.shape) ? 1 : 0);
  const double cost = std::log(static_cast<double>(evidence.blocks()) -
                               static_cast<double>(evidence.missing().size()));
  const OrdinateMeans means{linear_columns(evidence, trial.at), {}};
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
void put_in_order(DriftTrial& trial) {
  if (trial.at.log_times.size() < 2) return;
  VectorXd& b = trial.fit.coefficients;
  if (std::abs(b(0)) >= std::abs(b(1))) return;
  std::swap(trial.at.log_times[0], trial.at.log_times[1]);
  std::swap(b(0), b(1));
  trial.fit.covariance.row(0).swap(trial.fit.covariance.row(1));
  trial.fit.covariance.col(0).swap(trial.fit.covariance.col(1));
}

}  // namespace

TimeRange time_range(const DriftEvidence& evidence) {
  return {2.0 * evidence.block_s(), 10.0 * evidence.duration_s()};
}

MatrixXd whole_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  MatrixXd exponentials(evidence.blocks(), static_cast<Index>(at.log_times.size()));
  for (std::size_t k = 0; k < at.log_times.size(); ++k)
    exponentials.col(static_cast<Index>(k)) = evidence.rise(std::exp(at.log_times[k]));
  return beside(exponentials, fixed_columns(evidence, at));
}

MatrixXd linear_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  return whole_columns(evidence, at).bottomRows(evidence.blocks() - 1);
}

MatrixXd tangent_columns(const DriftEvidence& evidence, const ShapeAt& at) {
  const Index rows = evidence.blocks() - 1;
  MatrixXd tangents(rows, static_cast<Index>(at.log_times.size()));
  for (std::size_t k = 0; k < at.log_times.size(); ++k)
    tangents.col(static_cast<Index>(k)) =
        evidence.rise_by_log_time(std::exp(at.log_times[k])).tail(rows);
  return beside(linear_columns(evidence, at), tangents);
}

DriftTrial try_shape(const DriftEvidence& evidence, const NoiseChoice& choice, DriftShape shape) {
  DriftTrial trial;
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
