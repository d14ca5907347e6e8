#include "input/saturated_rests.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/signal/unusable.hpp"

namespace proofmass::app {

bool drop_saturated_rests(const std::vector<std::size_t>& channels, Recording& recording) {
  const std::vector<Note> found = signal::drop_saturated_rests(channels, recording);
  recording.notes.insert(recording.notes.end(), found.begin(), found.end());
  return !found.empty();
}

bool is_measured(const Recording& recording,
                 const std::vector<std::size_t>& channels,
                 const calibrate::Dwell& dwell) {
  constexpr std::ptrdiff_t fewest = 2;
  return std::ranges::all_of(channels, [&](std::size_t c) {
    const View<double> values = View<double>(recording.channels[c].values)
                                    .subspan(dwell.first, dwell.last - dwell.first + 1);
    return std::ranges::count_if(values, [](double v) { return std::isfinite(v); }) >= fewest;
  });
}

}  // namespace proofmass::app
