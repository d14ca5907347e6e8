#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

enum class EventKind { knock, step };

/// Something that noise, drift and lines do not do: a knock is over within seconds and leaves the
/// level as it was, a step leaves it changed.
struct Event {
  EventKind kind;
  std::size_t first, last;  ///< samples, inclusive; a bare step: the first sample at the new level
  double size;  ///< knock: largest departure from the local level; step: level after less before
  double significance;  ///< in standard deviations of the filter that saw it, about that place
};

struct EventOptions {
  double rate_hz;  ///< sampling rate of the series
};

/// Knocks and steps in a series of a resting sensor, ascending, not overlapping. Windows of w = 1,
/// 2, 4, … samples slide along the series; with m their means, w apart, the two filters are
///
///     knock: m[k] − (m[k−2] + m[k−1] + m[k+1] + m[k+2]) / 4          w = 1 … 2 s,
///     step:  (m[k−2] − 3 m[k−1] + 3 m[k] − m[k+1]) / 2               w = 16 … 30 s or 1024,
///
/// both with w up to N / 32 from 16 samples on. Neither passes constants and slopes, so that white
/// noise, flicker noise, random walk, lines and resonances all come out stationary, and each
/// output is judged by its own scatter σ: the median over short blocks of √(π/2) · mean |output|,
/// the larger of that of the surrounding minute or more and that of the record. An event exceeds
/// σ √(2 ln 1000 n) for n outputs, and what a Gumbel law through the quartiles of the blocks'
/// largest outputs reaches once in a hundred records, so that heavy tails raise the bar. Scales
/// run from short to long; what one finds is taken out before the next.
///
/// A knock must also depart the same way from the level before and from that after. A step must
/// stand alone among its neighbours, as the bend of a warm-up does not, and be at least half as
/// high through windows a quarter as wide; two that cancel within 5 s are a knock, and a knock
/// beside a step is part of it. Of two steps nearer than 2 w only the first found is told.
///
/// Source: the bank is in the manner of D. L. Donoho, I. M. Johnstone, Ideal spatial adaptation by
/// wavelet shrinkage, Biometrika 81 (1994) 425, section 2.2 (the bound σ √(2 ln n)).
///
/// NaN, infinities and runs of a repeated value far longer than the usual ones (a stuck or clipped
/// sensor) count as missing. Where the data do not reach half a quantum of noise, σ is at least
/// half a quantum for knocks and a third of one for steps.
/// Errors: none. rate_hz must be positive and finite.
/// Cost: O(N), about 8 ns a sample; allocates about N / 4 doubles, none for each sample.
[[nodiscard]] std::vector<Event> find_events(View<double> series, const EventOptions& options);

/// Sets to NaN the samples of the events and a margin of 0.1 s, or 2 samples if more, at each side;
/// what lies beyond a step stays on its new level.
void drop_events(std::span<double> series, const std::vector<Event>& events, double rate_hz);

}  // namespace proofmass::signal
