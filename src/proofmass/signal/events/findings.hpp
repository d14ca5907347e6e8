#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/events/source.hpp"

// Findings of the scales, before they are assembled into events.
namespace proofmass::signal {

/// A detection of the outlier filter.
struct Hit {
  Stretch at;
  double sigmas;
};

/// A detection of the step filter.
struct Step {
  std::size_t at;       ///< the first sample at the new level
  double size, sigmas;  ///< size: level after minus before
  std::size_t window;   ///< samples per window of the filter
};

/// Sorts the hits and joins those that overlap or are up to `apart` samples apart.
void merge_hits(std::vector<Hit>& hits, std::size_t apart);

/// Deviation of m[k] from the level before and from the level after, each the mean of the windows w
/// and 2 w away, or of the one that exists. Returns the smaller if they agree in sign, else 0, so
/// that a step gives 0. At an end, if `ends` is set: deviation from the line through the nearest
/// four. NaN if there is too little data.
[[nodiscard]] double departure(View<double> m, std::size_t k, std::size_t w, bool ends);

}  // namespace proofmass::signal
