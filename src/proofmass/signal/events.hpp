#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

enum class EventKind { outlier, step };

/// A deviation that noise, drift and lines do not explain. An outlier (`knock` in documents) is
/// over within seconds and leaves the level unchanged; a step changes it.
struct Event {
  EventKind kind;
  std::size_t first, last;  ///< inclusive; a step alone: the first sample at the new level
  double size;  ///< outlier: largest deviation from the local level; step: level after minus before
  double significance;  ///< in local standard deviations of the output of the detecting filter
};

struct EventOptions {
  double rate_hz;  ///< sampling rate of the series
};

/// Detects outliers and steps in a series of a static sensor; ascending, not overlapping. Windows
/// of w = 1, 2, 4, … samples slide along the series; with m their means, w apart, the two filters
/// are
///
///     outlier: m[k] − (m[k−2] + m[k−1] + m[k+1] + m[k+2]) / 4          w = 1 … 2 s,
///     step:  (m[k−2] − 3 m[k−1] + 3 m[k] − m[k+1]) / 2               w = 16 … 30 s or 1024,
///
/// both with w up to N / 32 from 16 samples on. Neither passes constants or slopes, so the outputs
/// are stationary for white noise, flicker noise, random walk, lines and resonances.
///
/// - Scale: each output is compared with its own σ, the median over short blocks of √(π/2) · mean
///   |output|; the larger of the value for the surrounding minute or more and that of the record.
/// - Threshold: σ √(2 ln 1000 n) for n outputs, or the level that a Gumbel law through the
///   quartiles of the blocks' largest outputs reaches once in a hundred records, whichever is
///   larger: heavy tails raise it.
/// - Scales run from short to long; events found at one scale are removed before the next.
/// - An outlier must also deviate in the same direction from the level before and after it.
/// - A step must be isolated among its neighbours, which the bend of a warm-up is not, and at least
///   half as high through windows a quarter as wide.
/// - Two steps that cancel within 5 s are an outlier; an outlier next to a step is part of it. Of
///   two steps closer than 2 w only the first found is reported.
///
/// Source: the filter bank follows D. L. Donoho, I. M. Johnstone, Ideal spatial adaptation by
/// wavelet shrinkage, Biometrika 81 (1994) 425, section 2.2 (the bound σ √(2 ln n)).
///
/// NaN, infinities and runs of a repeated value far longer than usual (a stuck or clipped sensor)
/// count as missing. If the noise is below half a quantum, σ is at least half a quantum for
/// outliers and a third of one for steps.
/// Errors: none. rate_hz must be positive and finite.
/// Cost: O(N), about 8 ns per sample; allocates about N / 4 doubles in total.
[[nodiscard]] std::vector<Event> find_events(View<double> series, const EventOptions& options);

/// Sets to NaN the samples of the events and a margin of 0.1 s, or 2 samples if more, on each side;
/// samples after a step keep their new level.
void drop_events(std::span<double> series, const std::vector<Event>& events, double rate_hz);

}  // namespace proofmass::signal
