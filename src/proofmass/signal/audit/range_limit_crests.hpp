#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

// Level crossings of a series, used to detect both kinds of limits.
namespace proofmass::signal {

/// Slopes per sample at the crossings of a level, over three steps.
[[nodiscard]] std::vector<double> slopes_at(View<double> series, double level);

/// An interval above a level with both ends observed: the crossings, in samples.
struct Excursion {
  double from = 0.0, to = 0.0;
  [[nodiscard]] double duration() const { return to - from; }
  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

[[nodiscard]] std::vector<Excursion> excursions_above(View<double> series, double level);

/// The median deviation of the durations from their median, relative to it.
[[nodiscard]] double spread_of_durations(const std::vector<Excursion>& excursions);

/// Median number of samples from one excursion to the next.
[[nodiscard]] double period_of(const std::vector<Excursion>& excursions);

/// Residual of the line y = a + b x.
[[nodiscard]] double rms_about_line(View<double> x, View<double> y);

/// 0 if empty.
[[nodiscard]] double median_or_zero(View<double> values);

}  // namespace proofmass::signal
