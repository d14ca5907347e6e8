#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "proofmass/characterise/spectral_groups.hpp"
#include "proofmass/characterise/whittle.hpp"
#include "proofmass/core/quantity.hpp"

// Which terms, filters and correlation times a recording needs.
namespace proofmass::characterise {

/// Columns of the likelihood: those of Term, the white one possibly filtered.
inline constexpr int column_of_quantisation = static_cast<int>(Term::quantisation);
inline constexpr int column_of_white = static_cast<int>(Term::white);
inline constexpr int column_of_markov = static_cast<int>(Term::markov);

/// Flicker noise, random walk, Markov noise.
[[nodiscard]] constexpr bool is_slow(int column) {
  return column != column_of_quantisation && column != column_of_white;
}

/// Twice the log-likelihood that a term has to gain: χ² of one degree of freedom at 98.6 %. Of the
/// three terms that white noise does not have, one is then taken in by chance in about one
/// recording in fifty (the boundary halves it).
inline constexpr double needed_gain = 6.0;
/// The same of a ramp: a slope depends on so few frequencies that its ratio is larger by chance
/// than the theory of many says.
inline constexpr double needed_gain_of_ramp = 9.0;

/// A fit in progress: the likelihood, with the shapes chosen so far, and the terms still in.
struct Search {
  GroupedEvidence evidence;
  WhittleLikelihood likelihood;
  std::vector<int> all{0, 1, 2, 3};  ///< that the recording may hold
  std::vector<int> active = all;     ///< that it is taken to hold
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

/// With the terms whose shape is known.
[[nodiscard]] Search begin_search(GroupedEvidence evidence);

/// Lets the white term roll off, if the spectrum asks for it: the bandwidth in Hz.
[[nodiscard]] std::optional<Uncertain> find_bandwidth(Search& search);

/// Takes exponentially correlated noise in, if the spectrum asks for it: its time constant in s.
[[nodiscard]] std::optional<Uncertain> find_markov(Search& search, double duration_s);

struct Misfit {
  double relative = 0.0;  ///< root mean square of p/S − 1 beyond the scatter of p
  double p = 1.0;         ///< probability of so much scatter if the model is the noise
};

/// Lowers the weight of what the model cannot be expected to meet.
Misfit weigh_misfit(Search& search);

/// A filter that the weights no longer ask for goes again.
void reconsider_bandwidth(Search& search, std::optional<Uncertain>& bandwidth_hz);

/// Leaves quantisation noise out where a filter of another bandwidth does without it: next to a
/// roll-off near half the rate either passes for a part of the other.
void reconsider_quantisation(Search& search, std::optional<Uncertain>& bandwidth_hz);

/// Leaves out the term that is missed least, until each that is left is needed.
void eliminate(Search& search);

/// The columns but for one.
[[nodiscard]] std::vector<int> without(std::vector<int> columns, int column);

}  // namespace proofmass::characterise
