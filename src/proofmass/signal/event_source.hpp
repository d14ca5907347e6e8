#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "proofmass/core/view.hpp"

// What the search for events looks at: the series less the stretches that are missing from it, read
// a piece at a time, so that the series is never copied whole.
namespace proofmass::signal {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Stretch {
  std::size_t first, last;  ///< samples, inclusive
};

/// How many samples a time takes, rounded up.
[[nodiscard]] std::size_t samples_in(double seconds, double rate_hz);

/// The upper median, which leaves the values in another order; NaN if there are none.
[[nodiscard]] double median_of(std::span<double> values);

/// The series with what must not be looked at taken out.
struct Source {
  View<double> series;
  std::vector<Stretch> missing;  ///< ascending, not overlapping

  /// Samples from `first`, which may lie before the series; NaN where there is none.
  void read(std::ptrdiff_t first, std::span<double> out) const;
  [[nodiscard]] std::vector<double> read(std::size_t first, std::size_t count) const;
};

/// The mean of the samples that are there; NaN if fewer than half are.
[[nodiscard]] double mean_of(const Source& source, std::size_t first, std::size_t count);

/// How finely a series is resolved, and where it is stuck.
struct Grain {
  double quantum = 0.0;        ///< least difference between neighbours that is not zero
  std::vector<Stretch> stuck;  ///< runs of one value 20 times as long as the mean run
};

/// One pass over the series; NaN equals nothing.
[[nodiscard]] Grain grain_of(View<double> series);

}  // namespace proofmass::signal
