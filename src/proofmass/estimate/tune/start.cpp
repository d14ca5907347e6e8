#include "proofmass/estimate/tune/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate {
namespace {

// Means of blocks of two; NaN where one is missing.
std::vector<double> halved(const std::vector<double>& values) {
  std::vector<double> out(values.size() / 2);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = 0.5 * (values[2 * k] + values[2 * k + 1]);
  return out;
}

struct Differences {
  double squares = 0.0;
  std::size_t count = 0;
};

void add_differences(const std::vector<double>& values, Differences& into) {
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = values[k] - values[k - 1];
    if (std::isnan(step)) continue;
    into.squares += step * step;
    ++into.count;
  }
}

// Values of the grid besides R and Q, each relative to them.
struct StartCandidate {
  double Q_over_R;      // of the first state, a sample
  double second = 0.0;  // as the model takes it
  double third = 0.0;   // time constant as a share of the record
};

std::vector<StartCandidate> grid(TuneModel model, const LevelNoise& noise) {
  const double found = noise.R > 0.0 ? noise.Q / noise.R : 1.0;
  switch (model) {
    case TuneModel::rest:
    case TuneModel::pva:
    case TuneModel::local_level:
      return {{found}, {1e-8}, {1e-5}, {1e-3}, {0.1}, {10.0}};
    case TuneModel::rest_markov:
    case TuneModel::pva_bias:
      return {{0.01 * found, 0.0, 1e-3}, {0.01 * found, 0.0, 0.01}, {0.01 * found, 0.0, 0.1},
              {found, 0.0, 1e-3},        {found, 0.0, 0.01},        {found, 0.0, 0.1}};
    case TuneModel::local_trend: {
      std::vector<StartCandidate> all;
      for (const double level : {1e-5, 1e-3, 0.1, 10.0}) {
        for (const double slope : {1e-10, 1e-7, 1e-4, 0.1}) all.push_back({level, slope});
      }
      return all;
    }
    case TuneModel::position: {
      std::vector<StartCandidate> all;
      for (const double q : {1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3}) all.push_back({q});
      return all;
    }
  }
  return {};
}

// The variance, or density, of a parameter's value.
double value_of(const TuneParameter& parameter, double variance) {
  return parameter.variance_power() == 2 ? std::sqrt(variance) : variance;
}

std::vector<double> values_of(TuneModel model,
                              const StartCandidate& candidate,
                              const LevelNoise& noise,
                              const TuneSeries& series) {
  const View<TuneParameter> parameters = parameters_of(model);
  const double h = 1.0 / series.rate_hz, R = noise.R, Q = candidate.Q_over_R * R;
  std::vector<double> values(parameters.size());
  values[0] = value_of(parameters[0], parameters[0].second_power == 0.5 ? R * h : R);
  if (model == TuneModel::position) {
    values[1] = Q / std::pow(h, 5);
    return values;
  }
  values[1] = value_of(parameters[1], Q / h);
  if (model == TuneModel::local_trend) values[2] = candidate.second * R / (h * h * h);
  if (parameters.size() == 4) {
    std::size_t longest = 0;
    for (const View<double> segment : series.segments) longest = std::max(longest, segment.size());
    const double tau_s = std::max(5.0 * h, candidate.third * static_cast<double>(longest) * h);
    values[2] = std::sqrt(std::max(0.5 * noise.Q / h * tau_s, 1e-4 * R));
    values[3] = tau_s;
  }
  return values;
}

void set_values(TuneProblem& problem, const std::vector<std::vector<double>>& values) {
  for (std::size_t k = 0; k < problem.unknowns.size(); ++k) {
    const TuneUnknown& unknown = problem.unknowns[k];
    double logs = 0.0;  // a shared parameter starts at the geometric mean
    for (const std::size_t s : unknown.series) logs += std::log(values[s][unknown.parameter]);
    problem.set(k, std::exp(logs / static_cast<double>(unknown.series.size())));
  }
}

// Whether all noises are unknown, so that a common factor can be set separately.
bool is_scalable(const TuneProblem& problem) {
  std::size_t noises = 0;
  for (const TuneParameter& parameter : parameters_of(problem.model())) {
    if (parameter.role != TuneRole::time_constant) noises += problem.series().size();
  }
  for (std::size_t k = 0; k < problem.unknowns.size(); ++k) {
    if (problem.parameter(k).role == TuneRole::time_constant) continue;
    noises -= problem.unknowns[k].series.size();
  }
  return noises == 0;
}

void scale_all(TuneProblem& problem, double factor) {
  for (std::size_t k = 0; k < problem.unknowns.size(); ++k) {
    const TuneParameter& parameter = problem.parameter(k);
    if (parameter.role == TuneRole::time_constant) continue;
    problem.set(k, problem.value(k) * std::pow(factor, 1.0 / parameter.variance_power()));
  }
}

double largest_reading(const TuneProblem& problem) {
  double most = 0.0;
  for (const TuneSeries* series : problem.series()) {
    for (const View<double> segment : series->segments) {
      for (const double x : segment) most = std::isnan(x) ? most : std::max(most, std::abs(x));
    }
  }
  return most;
}

}  // namespace

LevelNoise allan_start(const TuneSeries& series) {
  std::vector<std::vector<double>> blocks;
  for (const View<double> segment : series.segments) {
    blocks.emplace_back(segment.begin(), segment.end());
  }
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 2);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2);
  double first = 0.0;
  for (double m = 1.0;; m *= 2.0) {
    Differences found;
    for (const std::vector<double>& values : blocks) add_differences(values, found);
    constexpr std::size_t fewest = 8;
    if (found.count < (first > 0.0 ? fewest : 1) || !(found.squares > 0.0)) break;
    const double variance = 0.5 * found.squares / static_cast<double>(found.count);
    if (first == 0.0) first = variance;
    const Eigen::Vector2d row(1.0 / m, (2.0 * m * m + 1.0) / (6.0 * m));
    const double weight = static_cast<double>(found.count) * first * first / (variance * variance);
    A += weight * row * row.transpose();
    b += weight * variance / first * row;
    for (std::vector<double>& values : blocks) values = halved(values);
  }
  if (first == 0.0) return {};
  const Eigen::VectorXd x = non_negative_minimiser(A, b) * first;
  return {x(0), x(1)};
}

Status set_start(TuneProblem& problem) {
  if (problem.unknowns.empty()) return Done{};
  std::vector<LevelNoise> noises;
  for (const TuneSeries* series : problem.series()) {
    LevelNoise noise = allan_start(*series);
    noise.R = std::max(noise.R, 1e-3 * noise.Q);
    noise.Q = std::max(noise.Q, 1e-8 * noise.R);
    if (!(noise.R > 0.0)) noise = {1.0, 1.0};  // unit noises, to be scaled
    noises.push_back(noise);
  }
  constexpr std::size_t most_samples = 20'000;
  const bool scalable = is_scalable(problem);
  const double rounding = 1e-13 * largest_reading(problem);
  const TuneProblem begin = problem;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < grid(problem.model(), noises.front()).size(); ++k) {
    TuneProblem tried = begin;
    std::vector<std::vector<double>> values;
    for (std::size_t s = 0; s < noises.size(); ++s) {
      values.push_back(values_of(problem.model(), grid(problem.model(), noises[s])[k], noises[s],
                                 *problem.series()[s]));
    }
    set_values(tried, values);
    TuneScore score = tried.forward_score(most_samples);
    if (score.innovations == 0) continue;
    const auto count = static_cast<double>(score.innovations);
    if (scalable) {
      const double factor = score.squares / count;
      if (!(factor > 0.0)) continue;
      scale_all(tried, factor);
      score.log_likelihood += 0.5 * (score.squares - count * (std::log(factor) + 1.0));
    }
    if (score.log_likelihood > best && tried.system(0).R > rounding * rounding) {
      best = score.log_likelihood;
      problem = tried;
    }
  }
  if (!std::isfinite(best))
    return Error{Errc::not_observable,
                 "the data follow the model without noise: there is nothing to tune"};
  return Done{};
}

}  // namespace proofmass::estimate
