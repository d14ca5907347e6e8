#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/event_source.hpp"

// What the scales of the search find, before it is put together to events.
namespace proofmass::signal {

/// Where a knock filter stood out.
struct Hit {
  Stretch at;
  double sigmas;
};

/// Where a step filter stood out.
struct Step {
  std::size_t at;       ///< the first sample at the new level
  double size, sigmas;  ///< level after less before
  std::size_t window;   ///< samples in each window of the filter
};

/// Sorts the hits and joins those that overlap or are up to `apart` samples apart.
void merge_hits(std::vector<Hit>& hits, std::size_t apart);

/// How far m[k] stands out from the level before and from the level after, each the mean of the
/// windows w and 2 w away or of the one that is there: the lesser if they agree in sign, or 0, so
/// that a step is none. At an end, where `ends` asks for it, from the line through the nearest
/// four. NaN where there is too little.
[[nodiscard]] double departure(View<double> m, std::size_t k, std::size_t w, bool ends);

}  // namespace proofmass::signal
