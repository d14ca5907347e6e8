#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "proofmass/core/view.hpp"

// Input of the event search: the series without its missing segments, read in pieces, so that the
// series is never copied as a whole.
namespace proofmass::signal {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Stretch {
  std::size_t first, last;  ///< samples, inclusive
};

/// Number of samples in a time, rounded up.
[[nodiscard]] std::size_t samples_in(double seconds, double rate_hz);

/// The upper median; reorders the values. NaN if there are none.
[[nodiscard]] double median_of(std::span<double> values);

/// The series with excluded segments marked as missing.
struct Source {
  View<double> series;
  std::vector<Stretch> missing;  ///< ascending, not overlapping

  /// Reads samples from `first`, which may lie before the series; NaN where there is none.
  void read(std::ptrdiff_t first, std::span<double> out) const;
  [[nodiscard]] std::vector<double> read(std::size_t first, std::size_t count) const;
};

/// The mean of the samples present; NaN if fewer than half are.
[[nodiscard]] double mean_of(const Source& source, std::size_t first, std::size_t count);

/// Resolution of a series, and where it is stuck.
struct Grain {
  double quantum = 0.0;        ///< smallest nonzero difference of adjacent values
  std::vector<Stretch> stuck;  ///< runs of one value 20 times as long as the mean run
};

/// One pass over the series; NaN is not equal to anything.
[[nodiscard]] Grain grain_of(View<double> series);

}  // namespace proofmass::signal
