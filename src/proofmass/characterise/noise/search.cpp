#include "proofmass/characterise/noise/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "proofmass/characterise/noise/term_spectra.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::array linear_terms{Term::quantisation, Term::white, Term::flicker,
                                  Term::random_walk};

constexpr double shape_gain = 16.0;

// Excess scatter of the densities about the model: Σ ν/2 (p/S − 1)² has mean 1 and variance 2 +
// 12/ν for a group, being that of a gamma variable. Groups of few degrees of freedom are too skewed
// and are excluded.
Misfit find_misfit(const Search& search) {
  constexpr double enough_dof = 10.0, improbable = 1e-4;
  const Eigen::ArrayXd dof = search.likelihood.dof();
  const Eigen::ArrayXd departure =
      (search.likelihood.densities(search.fit) / search.fit.density.array() - 1.0).square();
  const Eigen::ArrayXd asked = (dof >= enough_dof).cast<double>();
  const double expected = asked.sum() - static_cast<double>(search.active.size());
  if (expected < 5.0) return {};
  const double scatter = std::sqrt((asked * (2.0 + 12.0 / dof)).sum());
  const double excess = ((0.5 * asked * dof * departure).sum() - expected) / scatter;
  Misfit misfit{0.0, 0.5 * std::erfc(excess / std::numbers::sqrt2)};
  if (misfit.p > improbable) return misfit;
  double low = 0.0, high = 100.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    const double sum = (asked * departure / (2.0 / dof + middle)).sum();
    (sum > expected ? low : high) = middle;
  }
  misfit.relative = std::sqrt(high);
  return misfit;
}

struct Shape {
  double time_constant_s = 0.0, log_likelihood = 0.0;
};

// The maximum-likelihood time constant in [low, high], with `set` installing a shape; approximate
// if the required gain is out of reach.
template <class Set>
Shape best_time_constant(
    Search& search, double low_s, double high_s, double needed, const Set& set) {
  const auto likelihood_at = [&](double log_s) {
    set(std::exp(log_s));
    return search.likelihood.maximise(search.active, {}, search.fit.strength).log_likelihood;
  };
  constexpr double step = 0.6;
  double best = std::log(low_s), top = likelihood_at(best);
  for (double log_s = best + step; log_s < std::log(high_s); log_s += step) {
    const double value = likelihood_at(log_s);
    if (value > top) {
      top = value;
      best = log_s;
    }
  }
  if (top - search.fit.log_likelihood < 0.25 * needed) return {std::exp(best), top};
  for (double width = 0.5 * step; width > 1e-3; width *= 0.5) {
    for (const double log_s : {best - width, best + width}) {
      if (log_s < std::log(low_s) || log_s > std::log(high_s)) continue;
      const double value = likelihood_at(log_s);
      if (value > top) {
        top = value;
        best = log_s;
      }
    }
  }
  return {std::exp(best), top};
}

// 1/√(−d²ℓ/d ln T²), the standard deviation of ln T.
template <class Set>
double std_of_log(Search& search, double time_constant_s, const Set& set) {
  constexpr double step = 0.05;
  const auto at = [&](double shift) {
    set(time_constant_s * std::exp(shift));
    return search.likelihood.maximise(search.active, {}, search.fit.strength).log_likelihood;
  };
  const double bend = (2.0 * at(0.0) - at(step) - at(-step)) / (step * step);
  set(time_constant_s);
  return bend > 0.0 ? 1.0 / std::sqrt(bend) : 1.0;
}

std::optional<Uncertain> bandwidth_that_gains(Search& search, double needed) {
  const double rate_hz = search.evidence.fast_sampling.rate_hz;
  const auto set = [&](double time_constant_s) {
    search.likelihood.set_column(column_of_white, search.relaxation(time_constant_s, 1.0));
  };
  const auto corner = [](double hz) { return 1.0 / (2.0 * std::numbers::pi * hz); };
  const Shape best =
      best_time_constant(search, corner(0.45 * rate_hz), corner(0.004 * rate_hz), needed, set);
  if (2.0 * (best.log_likelihood - search.fit.log_likelihood) < needed) {
    search.likelihood.set_column(column_of_white,
                                 VectorXd::Ones(static_cast<Index>(search.evidence.groups.size())));
    return std::nullopt;
  }
  set(best.time_constant_s);
  search.pole_s = best.time_constant_s;
  search.fit = search.likelihood.maximise(search.active, {}, search.fit.strength);
  const double bandwidth_hz = corner(best.time_constant_s);
  return Uncertain{bandwidth_hz, bandwidth_hz * std_of_log(search, best.time_constant_s, set)};
}

}  // namespace

Search begin_search(GroupedEvidence evidence) {
  const auto rows = static_cast<Index>(evidence.groups.size());
  auto groups = evidence.groups;
  Search search{.evidence = std::move(evidence),
                .likelihood = {std::move(groups), Eigen::MatrixXd::Zero(rows, term_count)},
                .pole_s = {},
                .markov_s = {}};
  for (std::size_t k = 0; k < linear_terms.size(); ++k) {
    const Term term = linear_terms[k];
    search.likelihood.set_column(static_cast<int>(k),
                                 search.column([=](double f, const Sampling& sampling) {
                                   return term_density(term, f, sampling);
                                 }));
  }
  search.fit = search.likelihood.maximise(search.active);
  return search;
}

// Departures of a real spectrum are smooth over about a third of an octave, which is eight groups:
// they count as one, not as eight.
Misfit weigh_misfit(Search& search) {
  constexpr double groups_that_go_together = 8.0;
  const Misfit misfit = find_misfit(search);
  if (misfit.relative > 0.0) {
    search.likelihood.allow_misfit(groups_that_go_together * misfit.relative * misfit.relative);
    search.fit = search.likelihood.maximise(search.active, {}, search.fit.strength);
  }
  return misfit;
}

std::optional<Uncertain> find_bandwidth(Search& search) {
  return bandwidth_that_gains(search, shape_gain);
}

void reconsider_quantisation(Search& search, std::optional<Uncertain>& bandwidth_hz) {
  if (!bandwidth_hz) return;
  Search rest = search;
  rest.active = without(search.active, column_of_quantisation);
  rest.pole_s.reset();
  rest.likelihood.set_column(column_of_white,
                             VectorXd::Ones(static_cast<Index>(rest.evidence.groups.size())));
  rest.fit = rest.likelihood.maximise(rest.active, {}, search.fit.strength);
  const auto found = bandwidth_that_gains(rest, needed_gain);
  if (2.0 * (search.fit.log_likelihood - rest.fit.log_likelihood) >= needed_gain) return;
  search = std::move(rest);
  bandwidth_hz = found;
}

void reconsider_bandwidth(Search& search, std::optional<Uncertain>& bandwidth_hz) {
  if (!bandwidth_hz) return;
  const VectorXd filtered = search.likelihood.column(column_of_white);
  const WhittleFit with = search.fit;
  search.likelihood.set_column(column_of_white, VectorXd::Ones(filtered.size()));
  search.fit = search.likelihood.maximise(search.active, {}, search.fit.strength);
  if (2.0 * (with.log_likelihood - search.fit.log_likelihood) < needed_gain) {
    bandwidth_hz.reset();
    search.pole_s.reset();
    return;
  }
  search.likelihood.set_column(column_of_white, filtered);
  search.fit = with;
}

std::optional<Uncertain> find_markov(Search& search, double duration_s) {
  const double rate_hz = search.evidence.fast_sampling.rate_hz;
  const double shortest_s = std::max(5.0 / rate_hz, 10.0 * search.pole_s.value_or(0.0));
  if (!(shortest_s < 0.05 * duration_s)) return std::nullopt;
  const auto set = [&](double time_constant_s) {
    search.likelihood.set_column(
        column_of_markov, search.relaxation(time_constant_s, time_constant_s * time_constant_s));
  };
  const double without = search.fit.log_likelihood;
  search.active.push_back(column_of_markov);
  const Shape best = best_time_constant(search, shortest_s, 0.1 * duration_s, shape_gain, set);
  if (2.0 * (best.log_likelihood - without) < shape_gain) {
    search.active.pop_back();
    return std::nullopt;
  }
  set(best.time_constant_s);
  search.markov_s = best.time_constant_s;
  search.all = search.active;
  search.fit = search.likelihood.maximise(search.active, {}, search.fit.strength);
  return Uncertain{best.time_constant_s,
                   best.time_constant_s * std_of_log(search, best.time_constant_s, set)};
}

std::vector<int> without(std::vector<int> columns, int column) {
  std::erase(columns, column);
  return columns;
}

void eliminate(Search& search) {
  while (search.active.size() > 1) {
    double least = needed_gain;
    int weakest = -1;
    WhittleFit best;
    for (const int column : search.active) {
      WhittleFit rest =
          search.likelihood.maximise(without(search.active, column), {}, search.fit.strength);
      const double loss = 2.0 * (search.fit.log_likelihood - rest.log_likelihood);
      if (loss >= least) continue;
      least = loss;
      weakest = column;
      best = std::move(rest);
    }
    if (weakest < 0) return;
    search.active = without(search.active, weakest);
    search.fit = std::move(best);
  }
}

}  // namespace proofmass::characterise
