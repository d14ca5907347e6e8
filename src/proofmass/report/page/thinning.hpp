#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

// Reduction of long series for plotting that preserves extremes.
namespace proofmass::report {

/// Number of intervals into which a long curve is divided: about one per unit of a plot's width.
inline constexpr std::size_t max_buckets = 1000;

struct Polyline {
  std::vector<double> x, y;
};

/// The curve reduced to `buckets` intervals of equally many values. Each keeps its first, smallest,
/// largest and last value, so that no spike is lost, as it would be in an average. Unchanged if it
/// has at most four values per interval. An interval with a value that is not finite ends in a NaN,
/// so that the gap remains visible. Preconditions: x and y have equal lengths, buckets > 0.
[[nodiscard]] Polyline thinned(View<double> x, View<double> y, std::size_t buckets = max_buckets);

struct Envelope {
  std::vector<double> x, lower, upper;
};

/// The reduced band: smallest lower and largest upper bound of each interval, at its middle x. NaN
/// if an interval has no finite bound.
[[nodiscard]] Envelope thinned_band(View<double> x,
                                    View<double> lower,
                                    View<double> upper,
                                    std::size_t buckets = max_buckets);

}  // namespace proofmass::report
