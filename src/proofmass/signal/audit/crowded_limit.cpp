#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/range_limit.hpp"
#include "proofmass/signal/audit/range_limit_crests.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t fewest_short_visits = 12;
// Mean of a visit, in samples: find_hard_limit() recognises longer ones by their constant segments.
constexpr double longest_visit = 16.0;

/// Smallest step between the values; 0 if they are not quantised.
double step_of(View<double> descending, double range) {
  double least = range;
  for (std::size_t k = 1; k < descending.size(); ++k)
    if (const double step = descending[k - 1] - descending[k]; step > 1e-9 * range)
      least = std::min(least, step);
  return least < 1e-3 * range ? 0.0 : least;
}

/// The level at which values crowd: there is a width below the highest value, at most a 20th of the
/// range, within which their density is three times that of the interval below it. That of a
/// sine, with its arcsine density, is 1/(√2 − 1) = 2.4 times, and that of a signal with crests of
/// different height is lower.
std::optional<double> find_crowd(View<double> series, const Extent& extent) {
  constexpr double rise = 3.0, significant = 4.0, fewest = 24.0;
  const double top = extent.high, range = extent.range();
  std::vector<double> upper;
  std::ranges::copy_if(series, std::back_inserter(upper),
                       [&](double x) { return x > top - range / 8.0; });
  if (static_cast<double>(upper.size()) < fewest) return std::nullopt;
  std::ranges::sort(upper, std::ranges::greater{});
  const auto above = [&](double level) {
    return std::ranges::lower_bound(upper, level, std::ranges::greater{}) - upper.begin();
  };
  const double narrowest = std::max(range / 3000.0, 4.0 * step_of(upper, range));
  std::optional<double> level;
  double clearest = significant;
  for (double width = range / 20.0; width > narrowest; width /= 1.5) {
    const auto here = static_cast<double>(above(top - width));
    const double below = static_cast<double>(above(top - 2.0 * width)) - here;
    const double clear = (here - rise * below) / std::sqrt(here + rise * rise * below);
    if (here < fewest || clear < clearest) continue;
    clearest = clear;
    level = upper[static_cast<std::size_t>(here / 2.0)];
  }
  // The width may cover a part of them: the interval is to be as wide below the level as above.
  for (int pass = 0; level && pass < 8; ++pass)
    level = upper[static_cast<std::size_t>(above(2.0 * *level - top)) / 2];
  return level;
}

/// Share of the values in the middle half of the range: none if the signal jumps between two
/// levels.
double share_between(View<double> series, const Extent& extent) {
  const auto between = std::ranges::count_if(series, [&](double x) {
    return x > extent.low + 0.25 * extent.range() && x < extent.high - 0.25 * extent.range();
  });
  return static_cast<double>(between) / static_cast<double>(series.size());
}

double mean_slope_at(View<double> series, double level) {
  Moments slopes;
  for (const double slope : slopes_at(series, level)) slopes.add(std::abs(slope));
  return slopes.mean;
}

/// Duration of an excursion above a level at this height over the median, for a slope at its ends
/// and the curvature of the series' own oscillation there: a parabola's, 2 s / (h ω²), with ω from
/// the crossings of the median. Source: S. O. Rice, Bell System Technical Journal 24 (1945) 46,
/// section 3.3, for the crossings.
double duration_of_excursion(View<double> series,
                             const Extent& extent,
                             double height,
                             double slope) {
  const auto crossings = static_cast<double>(slopes_at(series, extent.median).size());
  const double omega = std::numbers::pi * crossings / static_cast<double>(series.size());
  return 2.0 * slope / (height * square(omega));
}

}  // namespace

std::optional<RangeLimit> find_crowded_limit(View<double> series, const Extent& extent) {
  constexpr std::size_t fewest_values = 200;
  if (series.size() < fewest_values || !(extent.range() > 0.0)) return std::nullopt;
  const auto level = find_crowd(series, extent);
  if (!level) return std::nullopt;
  // The noise reaches as far below the level as above it.
  const double edge = *level - 1.5 * (extent.high - *level);
  const std::vector<Excursion> visits = excursions_above(series, edge);
  // Equal visits may be the shape of the motion.
  if (visits.size() < fewest_short_visits || spread_of_durations(visits) < 0.1) return std::nullopt;
  const auto samples = static_cast<std::size_t>(
      std::ranges::count_if(series, [edge](double x) { return x > edge; }));
  const double duration = static_cast<double>(samples) / static_cast<double>(visits.size());
  if (duration > longest_visit || share_between(series, extent) < 0.15) return std::nullopt;
  const double slope = mean_slope_at(series, edge);
  if (slope < 0.35 * mean_slope_at(series, edge - 0.2 * extent.range())) return std::nullopt;
  const double expected = duration_of_excursion(series, extent, edge - extent.median, slope);
  if (duration < expected / 3.0 || duration > 3.0 * expected) return std::nullopt;
  // The noise lifts half of those at the limit above it.
  const auto lifted = static_cast<std::size_t>(
      std::ranges::count_if(series, [level](double x) { return x > *level; }));
  return RangeLimit{RangeLimit::Kind::hard, *level, std::min(2 * lifted, samples)};
}

}  // namespace proofmass::signal
