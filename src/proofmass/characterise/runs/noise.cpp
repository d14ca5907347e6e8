#include "proofmass/characterise/runs/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/characterise/noise/whittle.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

// Γ, the generalised covariance of the noise's integral x: the variance of Σ a_i x(t_i) is
// ΣΣ a_i a_j Γ(t_i − t_j) for all a with Σ a_i = Σ a_i t_i = 0. G. Matheron, Advances in Applied
// Probability 5 (1973) 439.
double generalised_covariance(const RunNoiseTerm& term, double t) {
  const double lag = std::abs(t);
  switch (term.kind) {
    case RunNoiseKind::white:
      return -0.5 * lag;
    case RunNoiseKind::flicker:
      return lag > 0.0 ? lag * lag * std::log(lag) / (2.0 * pi) : 0.0;
    case RunNoiseKind::random_walk:
      return lag * lag * lag / 12.0;
    case RunNoiseKind::markov:
      return -term.memory * term.memory * (std::expm1(-lag / term.memory) + lag / term.memory);
  }
  return 0.0;
}

// Covariance of means over `window` whose starts are `gap` apart, up to a constant that cancels in
// contrasts.
double mean_covariance(const RunNoiseTerm& term, double gap, double window) {
  return (2.0 * generalised_covariance(term, gap) - generalised_covariance(term, gap + window) -
          generalised_covariance(term, gap - window)) /
         (window * window);
}

// Orthonormal, k = 1 … n − 1 down the rows.
MatrixXd cosines(Index n) {
  MatrixXd C(n - 1, n);
  for (Index k = 1; k < n; ++k) {
    for (Index b = 0; b < n; ++b) {
      C(k - 1, b) = std::sqrt(2.0 / static_cast<double>(n)) *
                    std::cos(pi * static_cast<double>(k) * (static_cast<double>(b) + 0.5) /
                             static_cast<double>(n));
    }
  }
  return C;
}

VectorXd ordinates_of(const RunNoiseTerm& term, const MatrixXd& C) {
  const Index n = C.cols();
  const double block = 1.0 / static_cast<double>(n);
  VectorXd by_gap(n);
  for (Index d = 0; d < n; ++d)
    by_gap(d) = mean_covariance(term, static_cast<double>(d) * block, block);
  MatrixXd A(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) A(i, j) = by_gap(std::abs(i - j));
  return (C * A).cwiseProduct(C).rowwise().sum();
}

WhittleLikelihood likelihood_of(const VectorXd& P, double degrees, const MatrixXd& ordinates) {
  std::vector<SpectralGroup> groups;
  groups.reserve(static_cast<std::size_t>(P.size()));
  for (Index k = 0; k < P.size(); ++k)
    groups.push_back({.frequency_hz = static_cast<double>(k + 1), .density = P(k), .dof = degrees});
  return {std::move(groups), ordinates};
}

std::vector<RunNoiseTerm> all_terms() {
  return {{RunNoiseKind::white},
          {RunNoiseKind::flicker},
          {RunNoiseKind::random_walk},
          {RunNoiseKind::markov, 1.0 / 48.0},
          {RunNoiseKind::markov, 1.0 / 24.0},
          {RunNoiseKind::markov, 1.0 / 12.0},
          {RunNoiseKind::markov, 1.0 / 6.0}};
}

// Models, as lists of the terms above.
const std::vector<std::vector<int>> choices{
    {0}, {1},    {2},       {0, 1}, {0, 2}, {1, 2},    {0, 1, 2}, {3},    {0, 3},   {0, 3, 2},
    {4}, {0, 4}, {0, 4, 2}, {5},    {0, 5}, {0, 5, 2}, {6},       {0, 6}, {0, 6, 2}};

double parameters(const RunNoiseModel& model) {
  const bool has_memory = std::ranges::any_of(
      model.terms, [](const RunNoiseTerm& term) { return term.kind == RunNoiseKind::markov; });
  return static_cast<double>(model.terms.size()) + (has_memory ? 1.0 : 0.0);
}

// Estimates of Σ strength × part(term), one by each model.
template <class Part>
std::vector<VarianceEstimate> estimates(const RunNoise& noise, const Part& part) {
  if (noise.models.empty()) return {{}};
  std::vector<VarianceEstimate> found;
  for (const RunNoiseModel& model : noise.models) {
    VectorXd parts(model.strengths.size());
    for (Index j = 0; j < parts.size(); ++j)
      parts(j) = part(model.terms[static_cast<std::size_t>(j)]);
    const double std = std::sqrt(parts.dot(model.covariance * parts));
    found.push_back({parts.dot(model.strengths), std, model.weight});
  }
  return found;
}

}  // namespace

std::vector<VarianceEstimate> RunNoise::allan_variance(double tau_s) const {
  const double tau = tau_s / duration_s;
  return estimates(*this, [=](const RunNoiseTerm& term) {
    return mean_covariance(term, 0.0, tau) - mean_covariance(term, tau, tau);
  });
}

std::vector<VarianceEstimate> RunNoise::change_variance(double window_s) const {
  const double window = window_s / duration_s;
  return estimates(*this, [=](const RunNoiseTerm& term) {
    return 2.0 * (mean_covariance(term, 0.0, window) - mean_covariance(term, 1.0 - window, window));
  });
}

VectorXd RunNoise::ordinates(Index blocks) const {
  const MatrixXd C = cosines(blocks);
  VectorXd v = VectorXd::Zero(blocks - 1);
  for (const RunNoiseModel& model : models) {
    for (std::size_t j = 0; j < model.terms.size(); ++j)
      v += model.weight * model.strengths(static_cast<Index>(j)) * ordinates_of(model.terms[j], C);
  }
  return v;
}

MatrixXd cosine_coefficients(const MatrixXd& columns) {
  return cosines(columns.rows()) * columns;
}

RunNoise fit_run_noise(const MatrixXd& residuals, double duration_s) {
  RunNoise noise;
  noise.duration_s = duration_s;
  const double degrees = static_cast<double>(residuals.cols() - 1);
  const MatrixXd C = cosines(residuals.rows());
  const VectorXd P = (C * residuals).rowwise().squaredNorm() / degrees;
  if (!(P.mean() > 0.0)) return noise;
  const std::vector<RunNoiseTerm> terms = all_terms();
  MatrixXd ordinates(C.rows(), static_cast<Index>(terms.size()));
  for (std::size_t j = 0; j < terms.size(); ++j)
    ordinates.col(static_cast<Index>(j)) = ordinates_of(terms[j], C);
  const WhittleLikelihood likelihood = likelihood_of(P, degrees, ordinates);
  std::vector<double> criteria;
  for (const std::vector<int>& choice : choices) {
    const WhittleFit fit = likelihood.maximise(choice);
    const VectorXd strengths = fit.strength(choice);
    // A term that has shrunk to zero is the choice without it, which is also tried.
    constexpr double nothing = 1e-3;
    const VectorXd shares =
        strengths.cwiseProduct(ordinates(Eigen::all, choice).colwise().mean().transpose());
    if (shares.minCoeff() < nothing * P.mean()) continue;
    RunNoiseModel model;
    for (const int j : choice) model.terms.push_back(terms[static_cast<std::size_t>(j)]);
    model.strengths = strengths;
    model.covariance = positive_inverse(likelihood.information(fit, choice));
    criteria.push_back(-2.0 * fit.log_likelihood + 2.0 * parameters(model));
    noise.models.push_back(std::move(model));
  }
  const double least = *std::ranges::min_element(criteria);
  double sum = 0.0;
  for (const double criterion : criteria) sum += std::exp(0.5 * (least - criterion));
  for (std::size_t m = 0; m < criteria.size(); ++m)
    noise.models[m].weight = std::exp(0.5 * (least - criteria[m])) / sum;
  std::erase_if(noise.models, [](const RunNoiseModel& model) { return model.weight < 1e-6; });
  return noise;
}

}  // namespace proofmass::characterise
