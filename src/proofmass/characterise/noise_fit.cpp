#include "proofmass/characterise/noise_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

#include "proofmass/characterise/record_needed.hpp"
#include "proofmass/characterise/spectral_groups.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int column_of_white = 1, column_of_markov = 4, columns = 5;
constexpr std::array linear_terms{Term::quantisation, Term::white, Term::flicker,
                                  Term::random_walk};

constexpr double quantile_95_two_sided = 3.841458820694124;  // of χ² with one degree of freedom
constexpr double quantile_95_one_sided = 2.705543454095404;  // the square of 1.645
constexpr double normal_95 = 1.6448536269514722, normal_975 = 1.9599639845400545;
// χ² of one degree of freedom at 98.6 %: of the three terms that white noise does not have, one is
// then taken in by chance in about one recording in fifty (the boundary halves it).
constexpr double needed_gain = 6.0;
// A slope hangs on so few frequencies that its ratio is larger by chance than the theory of many
// says: the squares of Student's t with 8 degrees of freedom for those of the normal quantiles.
constexpr double ramp_gain = 9.0, ramp_two_sided = 5.318, ramp_one_sided = 3.458;
constexpr double shape_gain = 16.0;
// Of fewer samples the likelihood ratio's intervals are too narrow.
constexpr std::size_t fewest_samples = 100;
constexpr std::size_t fewest_groups = 12;

// A fit in progress: the likelihood, with the shapes chosen so far, and the terms still in.
struct Search {
  GroupedEvidence evidence;
  WhittleLikelihood likelihood;
  std::vector<int> all{0, 1, 2, 3};  ///< that the recording may hold
  std::vector<int> active = all;     ///< that it is taken to hold
  std::optional<double> pole_s;      ///< time constant of the white term's filter
  std::optional<double> markov_s;
  WhittleFit fit = {};

  [[nodiscard]] VectorXd column(const std::function<double(double, const Sampling&)>& shape) const {
    VectorXd values(static_cast<Index>(evidence.groups.size()));
    for (std::size_t g = 0; g < evidence.groups.size(); ++g)
      values(static_cast<Index>(g)) = evidence.seen(g, shape);
    return values;
  }
  [[nodiscard]] VectorXd relaxation(double time_constant_s, double strength) const {
    return column([=](double f, const Sampling& sampling) {
      return strength * relaxation_density(time_constant_s, f, sampling);
    });
  }
};

Search begin_search(GroupedEvidence evidence) {
  const auto rows = static_cast<Index>(evidence.groups.size());
  auto groups = evidence.groups;
  Search search{.evidence = std::move(evidence),
                .likelihood = {std::move(groups), Eigen::MatrixXd::Zero(rows, columns)},
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

struct Misfit {
  double relative = 0.0, p = 1.0;
};

// How much more the densities scatter about the model than they should: Σ ν/2 (p/S − 1)² has mean 1
// and variance 2 + 12/ν a group, being that of a gamma variable. Groups of few degrees of freedom
// are so skew that they could say anything, and are not asked.
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

// Lowers the weight of what the model cannot be expected to meet. Departures of a real spectrum run
// smoothly over about a third of an octave, which is eight groups: they say one thing, not eight.
Misfit weigh_misfit(Search& search) {
  constexpr double groups_that_go_together = 8.0;
  const Misfit misfit = find_misfit(search);
  if (misfit.relative > 0.0) {
    search.likelihood.allow_misfit(groups_that_go_together * misfit.relative * misfit.relative);
    search.fit = search.likelihood.maximise(search.active, {}, search.fit.strength);
  }
  return misfit;
}

struct Shape {
  double time_constant_s = 0.0, log_likelihood = 0.0;
};

// The time constant in [low, high] of greatest likelihood, `set` putting a shape in place.
template <class Set>
Shape best_time_constant(Search& search, double low_s, double high_s, const Set& set) {
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
  if (top - search.fit.log_likelihood < 0.25 * shape_gain) return {std::exp(best), top};
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

// Lets the white term roll off, if the spectrum asks for it.
std::optional<Uncertain> find_bandwidth(Search& search) {
  const double rate_hz = search.evidence.fast_sampling.rate_hz;
  const auto set = [&](double time_constant_s) {
    search.likelihood.set_column(column_of_white, search.relaxation(time_constant_s, 1.0));
  };
  const auto corner = [](double hz) { return 1.0 / (2.0 * std::numbers::pi * hz); };
  const Shape best =
      best_time_constant(search, corner(0.45 * rate_hz), corner(0.004 * rate_hz), set);
  if (2.0 * (best.log_likelihood - search.fit.log_likelihood) < shape_gain) {
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

// A filter that the widened weights no longer ask for goes again.
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

// Takes exponentially correlated noise in, if the spectrum asks for it.
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
  const Shape best = best_time_constant(search, shortest_s, 0.1 * duration_s, set);
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

std::vector<int> without(std::vector<int> columns_in, int column) {
  std::erase(columns_in, column);
  return columns_in;
}

// Leaves out the term that is missed least, until each that is left is needed.
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

struct Bracket {
  double inside, outside;
};

// Where a loss that grows like a square reaches a quantile: regula falsi (Illinois) on its root.
template <class Loss>
double crossing(const Loss& loss, Bracket bracket, double quantile) {
  const auto height = [&](double at) { return std::sqrt(loss(at)) - std::sqrt(quantile); };
  double a = bracket.inside, fa = height(a), b = bracket.outside, fb = height(b);
  const double near = 1e-4 * std::abs(b - a);
  for (int k = 0; k < 30 && std::abs(b - a) > near; ++k) {
    const double c = (a * fb - b * fa) / (fb - fa), fc = height(c);
    if (std::abs(fc) < 1e-4) return c;
    if (fc * fb < 0.0) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = c;
    fb = fc;
  }
  return b;
}

// What the density changes by, for a small relative change of each time constant that was fitted.
std::vector<VectorXd> changes_of_shape(const Search& search) {
  constexpr double step = 0.01;
  std::vector<VectorXd> changes;
  const auto add = [&](std::optional<double> time_constant_s, int column, int power) {
    const double strength = search.fit.strength(column);
    if (!time_constant_s || strength == 0.0) return;
    const auto shape = [&](double T) { return search.relaxation(T, std::pow(T, power)); };
    changes.push_back(
        strength / (2.0 * step) *
        (shape(*time_constant_s * std::exp(step)) - shape(*time_constant_s * std::exp(-step))));
  };
  add(search.pole_s, column_of_white, 0);
  add(search.markov_s, column_of_markov, 2);
  return changes;
}

// Covariance of some strengths, the time constants being uncertain too.
Eigen::MatrixXd covariance_of(const Search& search, const std::vector<int>& columns_in) {
  const std::vector<VectorXd> changes = changes_of_shape(search);
  const auto n = static_cast<Index>(columns_in.size());
  const auto more = static_cast<Index>(changes.size());
  Eigen::MatrixXd X(static_cast<Index>(search.evidence.groups.size()), n + more);
  for (Index k = 0; k < n; ++k)
    X.col(k) = search.likelihood.column(columns_in[static_cast<std::size_t>(k)]);
  for (Index k = 0; k < more; ++k) X.col(n + k) = changes[static_cast<std::size_t>(k)];
  const Eigen::ArrayXd weight = 0.5 * search.likelihood.dof() / search.fit.density.array().square();
  const Eigen::MatrixXd information = X.transpose() * (weight.matrix().asDiagonal() * X);
  return positive_inverse(information).topLeftCorner(n, n);
}

// By how much the variance of a strength grows for the time constants having been fitted.
double widening(const Search& search, int column) {
  if (!search.pole_s && !search.markov_s) return 1.0;
  std::vector<int> kept = without(search.active, column);
  kept.push_back(column);
  const Index last = static_cast<Index>(kept.size()) - 1;
  const Eigen::MatrixXd known = positive_inverse(search.likelihood.information(search.fit, kept));
  return std::max(1.0, covariance_of(search, kept)(last, last) / known(last, last));
}

// Twice the log-likelihood lost by holding one strength at a value, all others free, those too that
// were left out: what they could have taken its place belongs to its uncertainty. The loss is
// counted from the likelihood of the terms that were kept, which the free ones may exceed by
// chance.
class Profile {
 public:
  Profile(const Search& search, int column)
      : likelihood_(search.likelihood), rest_(without(search.all, column)), column_(column) {
    std::vector<int> kept = without(search.active, column);
    kept.push_back(column);
    top_ = likelihood_.maximise(kept, {}, search.fit.strength);
    const Eigen::MatrixXd information = likelihood_.information(top_, kept);
    scale_ = std::sqrt(positive_inverse(information).diagonal()(information.rows() - 1));
  }

  [[nodiscard]] double top() const { return top_.strength(column_); }

  [[nodiscard]] double loss(double strength) const {
    const WhittleLikelihood::Held held{column_, strength};
    const double at = likelihood_.maximise(rest_, held, top_.strength).log_likelihood;
    return 2.0 * std::max(0.0, top_.log_likelihood - at);
  }

  // Where the loss reaches a quantile: above the top, or below it (0 if it does not get there).
  [[nodiscard]] double upper(double quantile) const {
    double inside = top(), outside = inside + scale_ * std::sqrt(quantile);
    while (loss(outside) < quantile) {
      inside = outside;
      outside = top() + 2.0 * (outside - top());
    }
    return root(inside, outside, quantile);
  }
  [[nodiscard]] double lower(double quantile) const {
    if (top() <= 0.0 || loss(0.0) <= quantile) return 0.0;
    double inside = top(), outside = std::max(0.0, top() - scale_ * std::sqrt(quantile));
    while (outside > 0.0 && loss(outside) < quantile) {
      inside = outside;
      outside = std::max(0.0, top() - 2.0 * (top() - outside));
    }
    return root(inside, outside, quantile);
  }

 private:
  [[nodiscard]] double root(double inside, double outside, double quantile) const {
    return crossing([this](double at) { return loss(at); }, {inside, outside}, quantile);
  }

  const WhittleLikelihood& likelihood_;
  std::vector<int> rest_;
  int column_;
  WhittleFit top_;
  double scale_ = 0.0;
};

// All coefficients are roots of strengths.
Coefficient coefficient(const Search& search, int column, double std_of_strength) {
  const Profile profile(search, column);
  const bool in =
      std::find(search.active.begin(), search.active.end(), column) != search.active.end();
  Coefficient found;
  const double wider = widening(search, column);
  found.upper_95 = std::sqrt(profile.upper(wider * quantile_95_one_sided));
  found.upper_two_sided_95 = std::sqrt(profile.upper(wider * quantile_95_two_sided));
  found.lower_95 = in ? std::sqrt(profile.lower(wider * quantile_95_two_sided)) : 0.0;
  const double strength = search.fit.strength(column);
  // The last term left may be no more than the others were.
  if (in && strength > 0.0) {
    found.verdict = Verdict::identified;
    found.value = std::sqrt(strength);
    found.std = std_of_strength / (2.0 * found.value);
  } else {
    found.std = found.upper_95 / normal_95;
  }
  return found;
}

// Twice the log-likelihood lost by a slope, all terms free to explain the recording with it, those
// too that were left out: a random walk too weak to be seen for itself looks like a slope.
class SlopeProfile {
 public:
  explicit SlopeProfile(const Search& search) : search_(search), top_(log_likelihood(slope())) {}

  [[nodiscard]] double slope() const { return search_.fit.slope; }

  [[nodiscard]] double loss(double at) const {
    return 2.0 * std::max(0.0, top_ - log_likelihood(at));
  }

  // Above the slope that was found (direction 1) or below it (−1).
  [[nodiscard]] double end(double direction, double quantile) const {
    double inside = slope();
    double step = direction * std::sqrt(quantile * search_.fit.slope_variance);
    while (loss(inside + step) < quantile) {
      inside += step;
      step *= 2.0;
    }
    return crossing([this](double at) { return loss(at); }, {inside, inside + step}, quantile);
  }

 private:
  [[nodiscard]] double log_likelihood(double at) const {
    return search_.likelihood.at_slope(at)
        .maximise(search_.all, {}, search_.fit.strength)
        .log_likelihood;
  }

  const Search& search_;
  double top_;
};

Coefficient ramp_coefficient(const Search& search) {
  const SlopeProfile profile(search);
  const double slope = profile.slope();
  const double direction = slope < 0.0 ? -1.0 : 1.0;
  Coefficient found;
  found.upper_95 = std::abs(profile.end(direction, ramp_one_sided));
  found.upper_two_sided_95 = std::abs(profile.end(direction, ramp_two_sided));
  const double lower = direction * profile.end(-direction, ramp_two_sided);
  found.lower_95 = std::max(0.0, lower);
  if (profile.loss(0.0) > ramp_gain) {
    found.verdict = Verdict::identified;
    found.value = std::abs(slope);
    found.std = (found.upper_two_sided_95 - lower) / (2.0 * normal_975);
  } else {
    found.std = found.upper_95 / normal_95;
  }
  return found;
}

}  // namespace

Result<NoiseModelFit> fit_noise_model(const NoiseEvidence& evidence) {
  GroupedEvidence grouped = group_evidence(evidence);
  if (static_cast<std::size_t>(evidence.duration_s * evidence.spectrum.rate_hz) < fewest_samples ||
      grouped.groups.size() < fewest_groups)
    return Error{
        Errc::too_few_samples,
        fmt::format("a noise model needs {} samples, and 16 in one piece", fewest_samples)};
  Search search = begin_search(std::move(grouped));
  NoiseModelFit model;
  model.rate_hz = evidence.spectrum.rate_hz;
  model.duration_s = evidence.duration_s;
  model.ordinates = search.evidence.groups.size();
  model.bandwidth_hz = find_bandwidth(search);
  const auto time_constant = find_markov(search, evidence.duration_s);
  const Misfit misfit = weigh_misfit(search);
  reconsider_bandwidth(search, model.bandwidth_hz);
  model.misfit = misfit.relative;
  model.misfit_p = misfit.p;
  eliminate(search);

  const Eigen::MatrixXd covariance = covariance_of(search, search.active);
  const auto found = [&](int column) {
    const auto at = std::find(search.active.begin(), search.active.end(), column);
    const Index place = at - search.active.begin();
    return coefficient(search, column,
                       at == search.active.end() ? 0.0 : std::sqrt(covariance(place, place)));
  };
  model.quantisation = found(0);
  model.white = found(column_of_white);
  model.flicker = found(2);
  model.random_walk = found(3);
  model.slope_per_s = search.fit.slope;
  model.ramp = ramp_coefficient(search);
  if (time_constant) {
    const Coefficient strength = found(column_of_markov);
    if (strength.verdict == Verdict::identified) model.markov = {strength, *time_constant};
  }
  set_records_needed(model);
  return model;
}

}  // namespace proofmass::characterise
