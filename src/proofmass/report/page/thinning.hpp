#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

// Long series made short enough to draw, without losing what stands out of them.
namespace proofmass::report {

/// Stretches that a long curve is drawn from: about one for each unit of the width of a plot.
inline constexpr std::size_t max_buckets = 1000;

struct Polyline {
  std::vector<double> x, y;
};

/// The curve thinned to `buckets` stretches of equally many values, each of which keeps its first,
/// smallest, largest and last: no spike is lost, which is why it is not an average. The curve as it
/// is where it has at most four values for each. A stretch with a value that is not finite ends in
/// a NaN, so that the gap stays to be seen. x and y are equally long, buckets > 0.
[[nodiscard]] Polyline thinned(View<double> x, View<double> y, std::size_t buckets = max_buckets);

struct Envelope {
  std::vector<double> x, lower, upper;
};

/// The band thinned: least lower and greatest upper bound of each stretch, at its middle x. NaN
/// where a stretch has no finite bound.
[[nodiscard]] Envelope thinned_band(View<double> x,
                                    View<double> lower,
                                    View<double> upper,
                                    std::size_t buckets = max_buckets);

}  // namespace proofmass::report
