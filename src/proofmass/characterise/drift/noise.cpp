#include "proofmass/characterise/drift/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/characterise/noise/golden_section.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// As in noise/search.cpp: one more term, and one more with a free time constant.
constexpr double gain_for_term = 6.0, gain_for_time = 16.0;
constexpr double cost_of_parameter = 2.0, gain_for_walk = 1.0, gain_for_walk_beside = 4.0;
constexpr int markov_times = 10;

VectorXd with_zero(const VectorXd& strength) {
  VectorXd more = VectorXd::Zero(strength.size() + 1);
  more.head(strength.size()) = strength;
  return more;
}

NoiseColumns without_walk(const NoiseColumns& columns) {
  NoiseColumns some;
  some.markov_time_constant_s = columns.markov_time_constant_s;
  some.P.resize(columns.P.rows(), columns.P.cols() - 1);
  for (std::size_t k = 0; k < columns.terms.size(); ++k) {
    if (columns.terms[k] == Term::random_walk) continue;
    some.P.col(static_cast<Index>(some.terms.size())) = columns.P.col(static_cast<Index>(k));
    some.terms.push_back(columns.terms[k]);
  }
  return some;
}

}  // namespace

int NoiseColumns::parameters() const {
  return static_cast<int>(terms.size()) + (markov_time_constant_s > 0.0 ? 1 : 0);
}

double NoiseColumns::strength(const OrdinateFit& fit, Term term) const {
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (terms[k] == term) return std::sqrt(fit.strength(static_cast<Index>(k)));
  return 0.0;
}

NoiseChoice::NoiseChoice(const DriftEvidence& evidence) : evidence_(evidence) {
  white_ = with({}, Term::white);
  base_ = with(white_, Term::random_walk);
  flicker_ = column(Term::flicker);
  // From the shortest visible in a block to a sixth of the record.
  const double shortest_s = 2.0 * evidence.block_s(), longest_s = evidence.duration_s() / 6.0;
  // With a few dozen values it is not distinguishable from a random walk.
  constexpr Index fewest_values = 64;
  if (evidence.blocks() < fewest_values) return;
  for (int k = 0; k < markov_times; ++k) {
    const double share = static_cast<double>(k) / (markov_times - 1);
    markov_times_s_.push_back(shortest_s * std::pow(longest_s / shortest_s, share));
    markov_.push_back(column(Term::markov, markov_times_s_.back()));
  }
}

VectorXd NoiseChoice::column(Term term, double time_constant_s) const {
  VectorXd density(evidence_.blocks() - 1);
  for (Index k = 0; k < density.size(); ++k) {
    const double f = evidence_.frequency_hz(k + 1);
    density(k) = term == Term::markov
                     ? time_constant_s * time_constant_s *
                           relaxation_density(time_constant_s, f, evidence_.sampling())
                     : term_density(term, f, evidence_.sampling());
  }
  return density;
}

NoiseColumns NoiseChoice::with(const NoiseColumns& columns,
                               Term term,
                               double time_constant_s) const {
  NoiseColumns more = columns;
  more.P.conservativeResize(evidence_.blocks() - 1, columns.P.cols() + 1);
  more.P.col(columns.P.cols()) = column(term, time_constant_s);
  more.terms.push_back(term);
  if (term == Term::markov) more.markov_time_constant_s = time_constant_s;
  return more;
}

NoiseColumns NoiseChoice::with_base(const NoiseColumns& columns) const {
  NoiseColumns more = base_;
  for (const Term term : columns.terms)
    if (term == Term::flicker || term == Term::markov)
      more = with(more, term, columns.markov_time_constant_s);
  return more;
}

NoiseColumns NoiseChoice::kept(const NoiseColumns& columns, const OrdinateFit& fit) {
  NoiseColumns some;
  for (std::size_t k = 0; k < columns.terms.size(); ++k) {
    const auto from = static_cast<Index>(k);
    if (!(fit.strength(from) > 0.0)) continue;
    some.P.conservativeResize(columns.P.rows(), some.P.cols() + 1);
    some.P.col(some.P.cols() - 1) = columns.P.col(from);
    some.terms.push_back(columns.terms[k]);
    if (columns.terms[k] == Term::markov)
      some.markov_time_constant_s = columns.markov_time_constant_s;
  }
  // For noiseless data the white term is kept, at zero.
  if (some.terms.empty()) {
    some.P = columns.P.leftCols(1);
    some.terms = {columns.terms.front()};
  }
  return some;
}

NoiseChoice::Option NoiseChoice::option(NoiseColumns columns,
                                        const VectorXd& z,
                                        const OrdinateMeans& means,
                                        const VectorXd& start) const {
  OrdinateFit fit = fit_ordinates(z, columns.P, means, start);
  return {std::move(columns), std::move(fit)};
}

// With a Markov term of the most likely time constant, if it can be significant.
std::optional<NoiseChoice::Option> NoiseChoice::with_markov(const Option& beside,
                                                            const VectorXd& z,
                                                            const OrdinateMeans& means) const {
  constexpr double hopeless = 0.25 * gain_for_time;
  if (promised_gain(z, beside.columns.P, means, beside.fit, markov_) < hopeless)
    return std::nullopt;
  VectorXd strength = with_zero(beside.fit.strength);
  NoiseColumns tried = with(beside.columns, Term::markov, markov_times_s_.front());
  const auto loss = [&](const VectorXd& shape) {
    tried.P.rightCols(1) = shape;
    OrdinateFit fit = fit_ordinates(z, tried.P, means, strength);
    strength = std::move(fit.strength);
    return -fit.log_likelihood;
  };
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < markov_.size(); ++k) {
    const double found = loss(markov_[k]);
    if (found >= least) continue;
    least = found;
    best = k;
  }
  // To a twentieth: the strength compensates for the rest.
  constexpr double tolerance = 0.05;
  const Bracket bracket{std::log(markov_times_s_[best > 0 ? best - 1 : 0]),
                        std::log(markov_times_s_[std::min(best + 1, markov_times_s_.size() - 1)]),
                        tolerance};
  const double log_time = least_between(bracket, [&](double log_time_s) {
                            return loss(column(Term::markov, std::exp(log_time_s)));
                          }).place;
  return option(with(beside.columns, Term::markov, std::exp(log_time)), z, means, strength);
}

// With flicker, if it can be significant.
std::optional<NoiseChoice::Option> NoiseChoice::with_flicker(const Option& beside,
                                                             const VectorXd& z,
                                                             const OrdinateMeans& means) const {
  constexpr double hopeless = 0.25 * gain_for_term;
  if (promised_gain(z, beside.columns.P, means, beside.fit, {&flicker_, 1}) < hopeless)
    return std::nullopt;
  return option(with(beside.columns, Term::flicker), z, means, with_zero(beside.fit.strength));
}

NoiseColumns NoiseChoice::choose(const VectorXd& z, const OrdinateMeans& means) const {
  Option chosen = option(base_, z, means);
  const auto gain = [](const std::optional<Option>& more, const Option& than) {
    return more ? 2.0 * (more->fit.log_likelihood - than.fit.log_likelihood) : 0.0;
  };
  // Any noise beyond white noise and a random walk must be significant; the choice between the
  // candidates is by Akaike's criterion.
  std::optional<Option> flicker = with_flicker(chosen, z, means);
  std::optional<Option> markov = with_markov(chosen, z, means);
  const double of_flicker = gain(flicker, chosen), of_markov = gain(markov, chosen);
  const bool is_flicker = of_flicker > gain_for_term;
  if (of_markov > gain_for_time && (!is_flicker || of_markov - of_flicker > cost_of_parameter)) {
    chosen = std::move(*markov);
    std::optional<Option> both = with_flicker(chosen, z, means);
    if (gain(both, chosen) > gain_for_term) chosen = std::move(*both);
  } else if (is_flicker) {
    chosen = std::move(*flicker);
    std::optional<Option> both = with_markov(chosen, z, means);
    if (gain(both, chosen) > gain_for_time) chosen = std::move(*both);
  }
  // A random walk with almost no evidence is dropped, since it would widen every interval. In
  // addition to another drift term it needs more evidence.
  const Option without = option(without_walk(chosen.columns), z, means);
  const double least =
      chosen.columns.terms.size() > base_.terms.size() ? gain_for_walk_beside : gain_for_walk;
  if (gain(chosen, without) < least) chosen = without;
  return kept(chosen.columns, chosen.fit);
}

}  // namespace proofmass::characterise
