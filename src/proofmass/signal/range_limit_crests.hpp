#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

// What both kinds of limits are told by: how a series crosses levels.
namespace proofmass::signal {

/// A series' lowest, middle and highest finite value.
struct Extent {
  double low = 0.0, median = 0.0, high = 0.0;
  [[nodiscard]] double range() const { return high - low; }
};

[[nodiscard]] Extent extent_of(View<double> series);

/// Slopes a sample where the series crosses a level, over three steps.
[[nodiscard]] std::vector<double> slopes_at(View<double> series, double level);

/// One stay above a level, of which both ends are seen: where it is crossed, in samples.
struct Excursion {
  double from = 0.0, to = 0.0;
  [[nodiscard]] double duration() const { return to - from; }
  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

[[nodiscard]] std::vector<Excursion> excursions_above(View<double> series, double level);

/// The median deviation of the durations from their median, as a share of it.
[[nodiscard]] double spread_of_durations(const std::vector<Excursion>& excursions);

/// Samples from one excursion to the next, by the median.
[[nodiscard]] double period_of(const std::vector<Excursion>& excursions);

/// Residual of the line y = a + b x.
[[nodiscard]] double rms_about_line(View<double> x, View<double> y);

/// None of none.
[[nodiscard]] double median_or_zero(View<double> values);

}  // namespace proofmass::signal
