#pragma once

#include <algorithm>
#include <cstddef>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/channel_audit.hpp"

// The loops that take most of an audit's time, compiled for the vector units of several processors.
// A fixed order of summation gives the same digits on all of them.
namespace proofmass::signal {

/// Statistics of one chunk of values.
struct ChunkStatistics {
  bool plausible = true;  ///< true if all values are; otherwise the other members are meaningless
  double sum = 0.0;
  double min = 0.0, max = 0.0;
};

/// Precondition: non-empty.
[[nodiscard]] ChunkStatistics chunk_statistics(View<double> values);

/// Calls odd(k) for each value k that is not plausible (is_plausible).
template <class Odd>
void for_each_implausible(View<double> values, Odd odd) {
  constexpr std::size_t chunk = 4096;
  for (std::size_t from = 0; from < values.size(); from += chunk) {
    const std::size_t end = std::min(from + chunk, values.size());
    if (chunk_statistics(values.subspan(from, end - from)).plausible) continue;
    for (std::size_t k = from; k < end; ++k)
      if (!is_plausible(values[k])) odd(k);
  }
}

/// Σ (x − mean)²
[[nodiscard]] double squares_about(View<double> values, double mean);

/// Σ z, Σ z² and Σ (z[k] − z[k−1])² of the departures z from the first value.
struct DepartureSums {
  double sum = 0.0, squares = 0.0, steps = 0.0;
};

/// Precondition: non-empty.
[[nodiscard]] DepartureSums sum_departures(View<double> values);

/// True if any value equals the previous one.
[[nodiscard]] bool has_repeats(View<double> values);

/// True if any value from the third on differs by less than `least` from the previous one or equals
/// the one before that.
[[nodiscard]] bool steps_are_fine_or_reversed(View<double> values, double least);

/// Number of values for which sign · x is below the bound.
[[nodiscard]] std::size_t count_below(View<double> values, double sign, double bound);

/// Deviations of the stamp intervals from the nominal one.
struct StepStatistics {
  bool regular = true;   ///< true if all intervals are within half a nominal period of it
  double squares = 0.0;  ///< Σ (interval − nominal)², valid if regular
};

/// Statistics of the intervals between adjacent stamps.
[[nodiscard]] StepStatistics step_statistics(View<double> stamps_s, double nominal_s);

/// Merges a chunk's statistics into the accumulated moments, by the formula for two samples of any
/// size. Source: T. F. Chan, G. H. Golub, R. J. LeVeque, Updating formulae and a pairwise algorithm
/// for computing sample variances, Stanford STAN-CS-79-773 (1979), equation 2.1.
void add_chunk(Moments& moments, const ChunkStatistics& figures, View<double> values);

}  // namespace proofmass::signal
