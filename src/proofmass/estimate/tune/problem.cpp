#include "proofmass/estimate/tune/problem.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"
#include "proofmass/fit/minimise_smooth.hpp"

namespace proofmass::estimate {
namespace {

// One Newton step if the surface is concave and the step goes uphill.
bool newton_step(TuneProblem& problem) {
  const TuneProblem::Slope at = problem.slope();
  const Eigen::MatrixXd H = information(problem);
  const SymmetricEigen eigen = symmetric_eigen(H);
  if (!(eigen.values(0) > 0.0)) return false;
  const Eigen::VectorXd g = Eigen::VectorXd::Map(at.gradient.data(), H.rows());
  const Eigen::VectorXd along = eigen.vectors.transpose() * g;
  const Eigen::VectorXd step = eigen.vectors * along.cwiseQuotient(eigen.values);
  constexpr double longest = 0.5;
  if (!(step.lpNorm<Eigen::Infinity>() < longest)) return false;
  const std::vector<double> before = problem.logs();
  std::vector<double> after = before;
  for (std::size_t k = 0; k < after.size(); ++k) after[k] += step(static_cast<Eigen::Index>(k));
  problem.set(after);
  if (problem.log_likelihood() >= at.log_likelihood - 1e-12 * std::abs(at.log_likelihood))
    return true;
  problem.set(before);
  return false;
}

}  // namespace

TuneProblem::TuneProblem(TuneModel model, std::vector<const TuneSeries*> series)
    : values(series.size(), std::vector<double>(parameters_of(model).size(), 1.0)),
      model_(model),
      series_(std::move(series)) {
  for (const TuneSeries* one : series_) readings_ += count_readings(*one);
}

std::size_t count_readings(const TuneSeries& series) {
  std::size_t count = 0;
  for (const View<double> segment : series.segments) {
    count += static_cast<std::size_t>(
        std::ranges::count_if(segment, [](double x) { return std::isfinite(x); }));
  }
  return count;
}

std::vector<double> TuneProblem::logs() const {
  std::vector<double> logs;
  for (std::size_t k = 0; k < unknowns.size(); ++k) logs.push_back(std::log(value(k)));
  return logs;
}

void TuneProblem::set(View<double> logs) {
  for (std::size_t k = 0; k < unknowns.size(); ++k) set(k, std::exp(logs[k]));
}

void TuneProblem::set(std::size_t unknown, double value) {
  for (const std::size_t s : unknowns[unknown].series) {
    values[s][unknowns[unknown].parameter] = value;
  }
}

double TuneProblem::value(std::size_t unknown) const {
  return values[unknowns[unknown].series.front()][unknowns[unknown].parameter];
}

TuneSystem TuneProblem::system(std::size_t series) const {
  return system_of(model_, values[series], 1.0 / series_[series]->rate_hz);
}

double TuneProblem::log_likelihood() const {
  double sum = 0.0;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    const TuneSystem own = system(s);
    for (const View<double> segment : series_[s]->segments) {
      sum += estimate::log_likelihood(own, segment).log_likelihood;
    }
  }
  return sum;
}

TuneScore TuneProblem::forward_score(std::size_t most) const {
  TuneScore sum;
  for (std::size_t s = 0; s < series_.size(); ++s) {
    const TuneSystem own = system(s);
    for (const View<double> segment : series_[s]->segments) {
      const TuneScore score =
          estimate::log_likelihood(own, segment.first(std::min(most, segment.size())));
      sum.log_likelihood += score.log_likelihood;
      sum.innovations += score.innovations;
      sum.squares += score.squares;
    }
  }
  return sum;
}

TuneProblem::Slope TuneProblem::slope() const {
  Slope out;
  out.gradient.assign(unknowns.size(), 0.0);
  out.readings.assign(unknowns.size(), 0);
  out.transitions.assign(unknowns.size(), 0);
  for (std::size_t s = 0; s < series_.size(); ++s) {
    const TuneSystem own = system(s);
    for (const View<double> segment : series_[s]->segments) {
      const TuneScore score = likelihood_score(own, segment);
      out.log_likelihood += score.log_likelihood;
      for (std::size_t k = 0; k < unknowns.size(); ++k) {
        if (std::ranges::find(unknowns[k].series, s) == unknowns[k].series.end()) continue;
        out.gradient[k] += score.by_log[unknowns[k].parameter];
        out.readings[k] += score.readings;
        out.transitions[k] += score.transitions;
      }
    }
  }
  return out;
}

double em_step(TuneProblem& problem) {
  const TuneProblem::Slope at = problem.slope();
  for (std::size_t k = 0; k < problem.unknowns.size(); ++k) {
    const TuneParameter& parameter = problem.parameter(k);
    const bool reading = parameter.role == TuneRole::reading;
    if (!reading && parameter.role != TuneRole::process) continue;
    const auto count = static_cast<double>(
        reading ? at.readings[k] : at.transitions[k] * static_cast<std::size_t>(parameter.driven));
    const int power = parameter.variance_power();
    const double grown = 1.0 + 2.0 * at.gradient[k] / (power * count);
    if (grown > 0.0) problem.set(k, problem.value(k) * std::pow(grown, 1.0 / power));
  }
  return at.log_likelihood;
}

TuneMaximum maximise(TuneProblem& problem, bool polished) {
  TuneMaximum out;
  if (!problem.unknowns.empty()) {
    const double scale = 1.0 / static_cast<double>(std::max<std::size_t>(problem.readings(), 1));
    const fit::SmoothFunction loss = [&](View<double> logs, std::span<double> gradient) {
      problem.set(logs);
      const TuneProblem::Slope at = problem.slope();
      for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] = -scale * at.gradient[k];
      return -scale * at.log_likelihood;
    };
    const std::vector<double> start = problem.logs();
    const auto found =
        fit::minimise_smooth(loss, start, {.gradient_tolerance = polished ? 1e-8 : 1e-6});
    problem.set(found ? found->parameters : start);
    out.iterations = found ? found->iterations : 0;
    out.converged = found.has_value() && found->converged;
    for (int k = 0; polished && k < 2 && newton_step(problem); ++k) ++out.iterations;
  } else {
    out.converged = true;
  }
  out.log_likelihood = problem.log_likelihood();
  return out;
}

Eigen::MatrixXd information(const TuneProblem& problem) {
  constexpr double step = 1e-4;
  const std::size_t n = problem.unknowns.size();
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd H(size, size);
  TuneProblem moved = problem;
  const std::vector<double> at = problem.logs();
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> logs = at;
    logs[k] = at[k] + step;
    moved.set(logs);
    const std::vector<double> above = moved.slope().gradient;
    logs[k] = at[k] - step;
    moved.set(logs);
    const std::vector<double> below = moved.slope().gradient;
    for (std::size_t j = 0; j < n; ++j) {
      H(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) =
          (below[j] - above[j]) / (2.0 * step);
    }
  }
  return 0.5 * (H + H.transpose());
}

}  // namespace proofmass::estimate
