#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "proofmass/characterise/noise/spectral_groups.hpp"
#include "proofmass/characterise/noise/whittle.hpp"
#include "proofmass/core/quantity.hpp"

// Selection of the terms, filters and correlation times required by a recording.
namespace proofmass::characterise {

/// Columns of the likelihood: those of Term, the white one possibly filtered.
inline constexpr int column_of_quantisation = static_cast<int>(Term::quantisation);
inline constexpr int column_of_white = static_cast<int>(Term::white);
inline constexpr int column_of_markov = static_cast<int>(Term::markov);

/// Flicker noise, random walk, Markov noise.
[[nodiscard]] constexpr bool is_slow(int column) {
  return column != column_of_quantisation && column != column_of_white;
}

/// Required gain of a term in twice the log-likelihood: χ² with one degree of freedom at 98.6 %.
/// One of the three non-white terms is then accepted by chance in about one recording in fifty (the
/// boundary halves it).
inline constexpr double needed_gain = 6.0;
/// Required gain of a ramp: a slope depends on so few frequencies that asymptotic theory
/// understates its chance gain.
inline constexpr double needed_gain_of_ramp = 9.0;

/// A fit in progress: the likelihood, with the current shapes and terms.
struct Search {
  GroupedEvidence evidence;
  WhittleLikelihood likelihood;
  std::vector<int> all{0, 1, 2, 3};  ///< candidates
  std::vector<int> active = all;     ///< included
  std::optional<double> pole_s;      ///< time constant of the white term's filter
  std::optional<double> markov_s;
  WhittleFit fit = {};

  [[nodiscard]] Eigen::VectorXd column(
      const std::function<double(double, const Sampling&)>& shape) const {
    Eigen::VectorXd values(static_cast<Eigen::Index>(evidence.groups.size()));
    for (std::size_t g = 0; g < evidence.groups.size(); ++g)
      values(static_cast<Eigen::Index>(g)) = evidence.seen(g, shape);
    return values;
  }
  [[nodiscard]] Eigen::VectorXd relaxation(double time_constant_s, double strength) const {
    return column([=](double f, const Sampling& sampling) {
      return strength * relaxation_density(time_constant_s, f, sampling);
    });
  }
};

/// Starts with the terms of known shape.
[[nodiscard]] Search begin_search(GroupedEvidence evidence);

/// Adds a roll-off of the white term, if significant: the bandwidth in Hz.
[[nodiscard]] std::optional<Uncertain> find_bandwidth(Search& search);

/// Adds exponentially correlated noise, if significant: its time constant in s.
[[nodiscard]] std::optional<Uncertain> find_markov(Search& search, double duration_s);

struct Misfit {
  double relative = 0.0;  ///< root mean square of p/S − 1 beyond the scatter of p
  double p = 1.0;         ///< p-value of the scatter under the model
};

/// Reduces the weight of data that the model cannot be expected to fit.
Misfit weigh_misfit(Search& search);

/// Drops the bandwidth term if it is no longer significant.
void reconsider_bandwidth(Search& search, std::optional<Uncertain>& bandwidth_hz);

/// Drops quantisation noise if a filter of another bandwidth replaces it: near a roll-off at half
/// the rate the two are similar.
void reconsider_quantisation(Search& search, std::optional<Uncertain>& bandwidth_hz);

/// Drops the least significant term, until all remaining ones are needed.
void eliminate(Search& search);

/// The columns without one.
[[nodiscard]] std::vector<int> without(std::vector<int> columns, int column);

}  // namespace proofmass::characterise
