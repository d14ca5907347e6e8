#include "proofmass/characterise/drift/selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/characterise/drift/shapes.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Two time constants closer than this are not distinguishable from one.
constexpr double least_ratio = 2.0;

constexpr std::array<DriftShape, 4> first_shapes{DriftShape::constant, DriftShape::line,
                                                 DriftShape::steps, DriftShape::exponential};
constexpr std::array<DriftShape, 2> further_shapes{DriftShape::exponential_and_line,
                                                   DriftShape::two_exponentials};

bool has_exponential(const DriftFitAtShape& trial) {
  return is_exponential(trial.at.shape);
}

// Length of the path of the whitened exponential over the unit sphere, with the fitted columns
// projected out, as T runs through its range.
double path_length(const DriftEvidence& evidence, const MatrixXd& fitted, const VectorXd& density) {
  constexpr int places = 60;
  const TimeRange range = time_range(evidence);
  const VectorXd root = density.cwiseSqrt().cwiseInverse();
  const MatrixXd X = root.asDiagonal() * fitted;
  const MatrixXd inverse = X.cols() > 0 ? positive_inverse(X.transpose() * X) : MatrixXd(0, 0);
  double length = 0.0;
  VectorXd last;
  for (int k = 0; k < places; ++k) {
    const double T = range.lower_s *
                     std::pow(range.upper_s / range.lower_s, static_cast<double>(k) / (places - 1));
    VectorXd e = root.cwiseProduct(evidence.rise(T).tail(evidence.blocks() - 1));
    if (X.cols() > 0) e -= X * (inverse * (X.transpose() * e));
    e.normalize();
    if (k > 0) length += std::acos(std::clamp(std::abs(e.dot(last)), 0.0, 1.0));
    last = std::move(e);
  }
  return length;
}

// Tests the exponential of a trial against the shape without it: the gain under the best of several
// noises.
GainTest against(const DriftEvidence& evidence,
                 const DriftFitAtShape& trial,
                 DriftShape without,
                 const std::vector<const NoiseColumns*>& noises) {
  const ShapeAt null{without, {}, {}};
  const OrdinateMeans means{linear_columns(evidence, null), tangent_columns(evidence, trial.at),
                            evidence.missing()};
  double best = -std::numeric_limits<double>::infinity();
  for (const NoiseColumns* noise : noises)
    best = std::max(best, fit_ordinates(evidence.contrasts(), noise->P, means).log_likelihood);
  GainTest tested;
  tested.deviance = std::max(0.0, 2.0 * (trial.fit.log_likelihood - best));
  const double L = path_length(evidence, means.fitted, trial.fit.density);
  tested.p = std::min(1.0, chi_square_p(tested.deviance, 1.0) +
                               L / std::numbers::pi * std::exp(-0.5 * tested.deviance));
  return tested;
}

double criterion(const DriftFitAtShape& trial) {
  return trial.candidate.information_criterion;
}

}  // namespace

DriftSelection::DriftSelection(const DriftEvidence& evidence)
    : evidence_(evidence), choice_(evidence) {
  trials_.reserve(first_shapes.size() + further_shapes.size() + rival_shapes.size());
  for (const DriftShape shape : first_shapes) add(shape);
  if (test(of(DriftShape::exponential), DriftShape::constant).p >= level) return;
  for (const DriftShape shape : further_shapes) add(shape);
  for (const DriftShape shape : rival_shapes) add(shape);
}

void DriftSelection::add(DriftShape shape) {
  DriftFitAtShape trial = try_shape(evidence_, choice_, shape);
  // Without a detected step it is the constant again; two equal ones add nothing.
  if (shape == DriftShape::steps && trial.at.step_blocks.empty()) return;
  if (shape == DriftShape::two_exponentials &&
      std::abs(trial.at.log_times[0] - trial.at.log_times[1]) < std::log(least_ratio))
    return;
  // Long after power-on a rival may equal a line within rounding.
  if (is_rival(shape) && !std::isfinite(criterion(trial))) return;
  trials_.push_back(std::move(trial));
}

const DriftFitAtShape& DriftSelection::of(DriftShape shape) const {
  const auto found = std::ranges::find(trials_, shape,
                                       [](const DriftFitAtShape& trial) { return trial.at.shape; });
  PM_EXPECTS(found != trials_.end());
  return *found;
}

const DriftFitAtShape& DriftSelection::best(bool exponential) const {
  constexpr double strong = 6.0;
  const DriftFitAtShape* best = nullptr;
  for (const DriftFitAtShape& trial : trials_) {
    if (has_exponential(trial) != exponential || is_rival(trial.at.shape)) continue;
    if (best == nullptr || criterion(trial) < criterion(*best) - strong) best = &trial;
  }
  return *best;
}

std::vector<const DriftFitAtShape*> DriftSelection::rivals() const {
  std::vector<const DriftFitAtShape*> found;
  for (const DriftFitAtShape& trial : trials_)
    if (is_rival(trial.at.shape)) found.push_back(&trial);
  return found;
}

std::vector<const DriftFitAtShape*> DriftSelection::as_good() const {
  std::vector<const DriftFitAtShape*> found;
  for (const DriftFitAtShape& trial : trials_)
    if (trial.at.shape != DriftShape::constant && trial.at.shape != DriftShape::steps)
      found.push_back(&trial);
  std::ranges::sort(found, {}, &DriftFitAtShape::akaike);
  const double akaike = found.front()->akaike(), schwarz = criterion(*found.front());
  std::erase_if(found, [&](const DriftFitAtShape* trial) {
    return std::min(trial->akaike() - akaike, criterion(*trial) - schwarz) > clear_margin;
  });
  return found;
}

GainTest DriftSelection::test(const DriftFitAtShape& trial, DriftShape without) const {
  return against(evidence_, trial, without, {&choice_.base(), &trial.noise, &of(without).noise});
}

GainTest DriftSelection::plain_test(const DriftFitAtShape& trial) const {
  const NoiseColumns& white = choice_.white();
  DriftFitAtShape plain = trial;
  plain.noise = white;
  plain.fit = fit_ordinates(evidence_.contrasts(), white.P, restricted(evidence_, trial.at));
  return against(evidence_, plain, DriftShape::constant, {&white});
}

DriftFitAtShape DriftSelection::with_hidden_walk(const DriftFitAtShape& trial) const {
  constexpr double negligible = 1e-3;  // of the likelihood
  constexpr int steps = 40;
  const double white = trial.noise.strength(trial.fit, Term::white);
  if (trial.noise.terms != std::vector{Term::white} || white <= 0.0) return trial;
  DriftFitAtShape walked = trial;
  walked.noise = choice_.base();
  const MatrixXd& P = walked.noise.P;
  const OrdinateMeans means = restricted(evidence_, trial.at);
  const auto with_walk = [&](double K) {
    return evaluate_ordinates(evidence_.contrasts(), P, means,
                              Eigen::Vector2d(white * white, K * K));
  };
  const double of_zero = with_walk(0.0).log_likelihood;
  // Where the walk is as strong as the white noise at the lowest frequency, it is seen.
  double longest = 0.01 * white * std::sqrt(P(0, 0) / P(0, 1));
  while (with_walk(longest).log_likelihood > of_zero + std::log(negligible)) longest *= 1.3;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double K = longest * k / steps;
    const double weight = std::exp(with_walk(K).log_likelihood - of_zero);
    sum += weight;
    squares += weight * K * K;
  }
  walked.fit = with_walk(std::sqrt(squares / sum));
  return walked;
}

std::vector<DriftCandidate> DriftSelection::candidates() const {
  std::vector<DriftCandidate> all;
  all.reserve(trials_.size());
  for (const DriftFitAtShape& trial : trials_) all.push_back(trial.candidate);
  std::ranges::sort(all, {}, &DriftCandidate::information_criterion);
  return all;
}

}  // namespace proofmass::characterise
