#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/range_limit.hpp"
#include "proofmass/signal/audit/range_limit_crests.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t window = 8;         // samples per window that is tested for a constant level
constexpr std::size_t fewest_visits = 8;  // minimum number of visits for a decision
constexpr double band = 5.0;              // half width of the limit, in noise standard deviations
constexpr double level_noise = 1.7;  // in noise stds: scatter of eight samples in 99 % of cases

/// A short segment.
struct Window {
  double mean = 0.0, std = 0.0;
};

std::vector<Window> windows_of(View<double> series) {
  std::vector<Window> out;
  for (std::size_t from = 0; from + window <= series.size(); from += window) {
    const Moments some = moments(series.subspan(from, window));
    if (some.count == window) out.push_back({some.mean, some.std()});
  }
  return out;
}

/// The level at which the highest values stay, and the noise there.
struct Ceiling {
  double level = 0.0, noise = 0.0;
  [[nodiscard]] double edge() const { return level - band * noise; }
};

/// Means and scatters of the constant windows within `reach` of the ceiling.
Ceiling refined(const std::vector<Window>& windows, const Ceiling& rough) {
  Moments means;
  double squares = 0.0;
  for (const Window& one : windows) {
    if (one.std >= level_noise * rough.noise) continue;
    if (std::abs(one.mean - rough.level) >= 4.0 * rough.noise / std::sqrt(double{window})) continue;
    means.add(one.mean);
    squares += square(one.std);
  }
  if (means.count < 10) return {};
  return {means.mean, std::sqrt(squares / static_cast<double>(means.count))};
}

/// True if the constant segments near the ceiling are all at it, within their noise.
bool is_one_level(const std::vector<Window>& windows, const Ceiling& ceiling) {
  Moments means;
  for (const Window& one : windows)
    if (one.std < level_noise * ceiling.noise && one.mean > ceiling.level - 6.0 * ceiling.noise)
      means.add(one.mean);
  return means.std() <= 2.0 * ceiling.noise / std::sqrt(double{window});
}

std::optional<Ceiling> find_ceiling(const std::vector<Window>& windows, const Extent& extent) {
  std::vector<double> scatters;
  for (const Window& one : windows)
    if (one.mean > extent.high - 0.15 * extent.range()) scatters.push_back(one.std);
  if (scatters.size() < 20) return std::nullopt;
  const double quiet = quantile(scatters, 0.25).value_or(0.0);
  std::vector<double> levels;
  for (const Window& one : windows)
    if (one.mean > extent.high - 0.15 * extent.range() && one.std < level_noise * quiet)
      levels.push_back(one.mean);
  Ceiling ceiling{median_or_zero(levels), quiet};
  for (int pass = 0; pass < 2 && ceiling.noise > 0.0; ++pass) ceiling = refined(windows, ceiling);
  // Without noise the signal is at the extreme itself, repeatedly.
  if (!(ceiling.noise > 0.0) || ceiling.noise > extent.range() / 25.0) return std::nullopt;
  if (extent.high > ceiling.level + 6.0 * ceiling.noise) return std::nullopt;
  return is_one_level(windows, ceiling) ? std::optional(ceiling) : std::nullopt;
}

/// One visit to the ceiling: slopes of arrival and departure, per sample.
struct Visit {
  std::size_t first = 0, end = 0;
  double rise = 0.0, fall = 0.0;
  bool is_smooth = false;  ///< the slopes continue further from the ceiling
  [[nodiscard]] double duration() const { return static_cast<double>(end - first); }
  [[nodiscard]] double slope() const { return std::min(rise, fall); }
  /// Height above the ceiling of a parabola with these slopes and this duration.
  [[nodiscard]] double height() const { return slope() * duration() / 4.0; }
};

bool go_on(double slope, double further) {
  return slope > 0.3 * further && further > 0.3 * slope;
}

std::vector<Visit> visits_to(View<double> series, double edge) {
  std::vector<Visit> out;
  for (std::size_t first = 0; first < series.size(); ++first) {
    if (!(series[first] > edge)) continue;
    std::size_t end = first + 1;
    while (end < series.size() && series[end] > edge) ++end;
    const std::size_t length = end - first, step = std::clamp<std::size_t>(length / 8, 2, 16);
    Visit visit{.first = first, .end = end};
    first = end;
    if (length < window || visit.first < 1 + 2 * step || end + 2 * step >= series.size()) continue;
    const auto before = [&](std::size_t k) { return series[visit.first - 1 - k * step]; };
    const auto after = [&](std::size_t k) { return series[end + k * step]; };
    const auto steps = static_cast<double>(step);
    visit.rise = (before(0) - before(1)) / steps;
    visit.fall = (after(0) - after(1)) / steps;
    visit.is_smooth = go_on(visit.rise, (before(1) - before(2)) / steps) &&
                      go_on(visit.fall, (after(1) - after(2)) / steps);
    if (std::isfinite(visit.rise + visit.fall)) out.push_back(visit);
  }
  return out;
}

double median_of(const std::vector<Visit>& visits, auto figure) {
  std::vector<double> figures;
  for (const Visit& visit : visits) figures.push_back(figure(visit));
  return median_or_zero(figures);
}

/// True if the signal would have continued beyond the ceiling.
bool are_run_into(const std::vector<Visit>& visits, double noise, double range) {
  const auto steep = static_cast<std::size_t>(std::ranges::count_if(visits, [&](const Visit& v) {
    return v.is_smooth && v.slope() > 0.0 && v.height() > 12.0 * noise;
  }));
  if (steep < 6 || steep * 2 < visits.size()) return false;
  if (median_of(visits, [](const Visit& v) { return v.height(); }) > 3.0 * range) return false;
  const double rise = median_of(visits, [](const Visit& v) { return v.rise; });
  const double fall = median_of(visits, [](const Visit& v) { return v.fall; });
  return rise > 0.5 * fall && rise < 2.0 * fall;
}

double median_slope_at(View<double> series, double level) {
  std::vector<double> slopes = slopes_at(series, level);
  for (double& slope : slopes) slope = std::abs(slope);
  return median_or_zero(slopes);
}

/// True if the slope decays towards the ceiling, as for a signal that settles.
bool settles(View<double> series, const Ceiling& ceiling, double range) {
  const double near = median_slope_at(series, ceiling.level - 6.0 * ceiling.noise - 0.02 * range);
  return near < 0.35 * median_slope_at(series, ceiling.level - 0.2 * range);
}

/// Segments in which the signal stays at other levels, between the extremes.
std::size_t count_holds_elsewhere(const std::vector<Window>& windows,
                                  const Ceiling& ceiling,
                                  const Extent& extent,
                                  double usual_visit) {
  const auto needed = std::max<std::size_t>(2, static_cast<std::size_t>(usual_visit / 16.0));
  const auto is_level = [&](const Window& one) {
    return one.std < 2.0 * ceiling.noise && one.mean < ceiling.level - 6.0 * ceiling.noise &&
           one.mean > extent.low + 0.03 * extent.range() + 6.0 * ceiling.noise;
  };
  std::size_t holds = 0;
  for (std::size_t k = 0; k < windows.size();) {
    std::size_t end = k + 1;
    if (is_level(windows[k])) {
      while (end < windows.size() && is_level(windows[end]) &&
             std::abs(windows[end].mean - windows[k].mean) < 2.0 * ceiling.noise)
        ++end;
      if (end - k >= needed) ++holds;
    }
    k = end;
  }
  return holds;
}

/// For each visit the ratio of the slope at the ceiling to that a third of the range below; true if
/// all are about 1.
bool have_straight_flanks(View<double> series, const std::vector<Visit>& visits, double below) {
  std::vector<double> ratios;
  for (const Visit& visit : visits) {
    std::size_t at = visit.first;
    while (at > 0 && series[at] >= below) --at;
    const std::size_t step = std::max<std::size_t>(2, (visit.first - at) / 6), half = step / 2 + 1;
    if (visit.first < 1 + step || at < half || at + half >= series.size()) continue;
    const double there = (series[at + half] - series[at - half]) / static_cast<double>(2 * half);
    const double here =
        (series[visit.first - 1] - series[visit.first - 1 - step]) / static_cast<double>(step);
    if (const double ratio = here / there; there > 0.0 && std::isfinite(ratio))
      ratios.push_back(ratio);
  }
  const double middle = median_or_zero(ratios);
  for (double& ratio : ratios) ratio = std::abs(ratio - middle);
  return std::abs(middle - 1.0) < 0.04 && median_or_zero(ratios) < 0.08;
}

/// True if the flanks after each excursion are those of a sine of this period, not straight lines.
bool are_flanks_of_a_sine(View<double> series,
                          const std::vector<Excursion>& excursions,
                          double lowest,
                          double tolerance) {
  const double period = period_of(excursions);
  std::vector<double> cosines, times, values;
  for (const Excursion& one : excursions) {
    for (auto k = static_cast<std::size_t>(std::ceil(one.to)); k < series.size(); ++k) {
      const double time = static_cast<double>(k) - one.middle();
      if (!(series[k] > lowest) || time > 0.5 * period) break;
      cosines.push_back(std::cos(2.0 * std::numbers::pi * time / period));
      times.push_back(time);
      values.push_back(series[k]);
    }
  }
  if (values.size() < 10) return false;
  const double off = rms_about_line(cosines, values);
  return off <= tolerance && rms_about_line(times, values) >= 1.1 * off;
}

}  // namespace

std::optional<RangeLimit> find_hard_limit(View<double> series, const Extent& extent) {
  const double range = extent.range();
  const std::vector<Window> windows = windows_of(series);
  const auto ceiling = find_ceiling(windows, extent);
  if (!ceiling) return std::nullopt;
  const std::vector<Visit> visits = visits_to(series, ceiling->edge());
  if (visits.size() < fewest_visits || !are_run_into(visits, ceiling->noise, range))
    return std::nullopt;
  if (settles(series, *ceiling, range)) return std::nullopt;
  const double usual = median_of(visits, [](const Visit& v) { return v.duration(); });
  if (3 * count_holds_elsewhere(windows, *ceiling, extent, usual) > visits.size())
    return std::nullopt;
  const auto excursions =
      excursions_above(series, ceiling->level - 6.0 * ceiling->noise - 0.1 * range);
  const double slope = median_of(visits, [](const Visit& v) { return v.slope(); });
  const bool alike =
      spread_of_durations(excursions) < std::max(0.015, 1.5 * ceiling->noise / (slope * usual));
  const bool is_cut = alike ? are_flanks_of_a_sine(series, excursions, extent.low + 0.06 * range,
                                                   2.0 * ceiling->noise + 0.003 * range)
                            : !have_straight_flanks(series, visits, ceiling->level - 0.35 * range);
  if (!is_cut) return std::nullopt;
  const auto at_limit =
      std::ranges::count_if(series, [&](double x) { return x > ceiling->edge(); });
  return RangeLimit{RangeLimit::Kind::hard, ceiling->level, static_cast<std::size_t>(at_limit)};
}

}  // namespace proofmass::signal
