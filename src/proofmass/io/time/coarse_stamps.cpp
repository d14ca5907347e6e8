#include "proofmass/io/time/coarse_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/time/stamp_steps.hpp"
#include "proofmass/signal/resample/hole_finder.hpp"
#include "proofmass/signal/resample/stamp_band.hpp"

namespace proofmass::io {
namespace {

// Rows that are examined, from the first: sufficient for each of these estimates.
constexpr std::size_t most_rows = std::size_t{1} << 18;

View<double> beginning(View<double> stamps) {
  return stamps.first(std::min(stamps.size(), most_rows));
}

/// Sample numbers if the stamps around an interval show what is missing in it.
std::vector<double> numbers_by_step(View<double> stamps, double step) {
  signal::HoleFinder finder(1.0 / step);
  std::vector<signal::Hole> holes;
  finder.add(stamps, holes);
  finder.finish(holes);
  std::vector<double> out;
  double number = 0.0;
  auto hole = holes.begin();
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    if (hole != holes.end() && hole->before == k) number += static_cast<double>((hole++)->missing);
    out.push_back(number);
    number += 1.0;
  }
  return out;
}

bool are_whole(const std::vector<double>& steps, double tick) {
  const auto off = std::ranges::count_if(
      steps, [&](double step) { return std::abs(std::remainder(step, tick)) > 1e-3 * tick; });
  return static_cast<std::size_t>(off) * 100 <= steps.size();
}

/// Increments of the stamps over runs of `rows` rows.
std::vector<double> rises_over(View<double> stamps, std::size_t rows) {
  std::vector<double> out;
  for (std::size_t from = 0; from + rows < stamps.size(); from += rows)
    if (is_stamp(stamps[from]) && is_stamp(stamps[from + rows]))
      out.push_back(stamps[from + rows] - stamps[from]);
  return out;
}

/// Ticks beyond (or short of) one per row in runs of `rows` rows.
std::vector<double> odd_ticks_over(View<double> stamps, std::size_t rows, double tick) {
  std::vector<double> out = rises_over(stamps, rows);
  for (double& rise : out) rise = std::abs(std::round(rise / tick) - static_cast<double>(rows));
  return out;
}

/// Odd ticks per row, without the runs in which several rows are missing.
double share_of_odd_ticks(View<double> stamps, double tick) {
  constexpr std::size_t rows = 16;
  const std::vector<double> odd = odd_ticks_over(stamps, rows, tick);
  const double usual = median(odd).value_or(0.0);
  Moments near;
  for (const double count : odd)
    if (std::abs(count - usual) <= 1.0) near.add(count);
  return near.mean / static_cast<double>(rows);
}

/// Largest probability of two adjacent numbers of events, for n independent ones of probability p.
double of_two_adjacent(std::size_t n, double p) {
  double at = std::pow(1.0 - p, static_cast<double>(n)), most = at;
  for (std::size_t k = 1; k <= n; ++k) {
    const double next =
        at * p / (1.0 - p) * static_cast<double>(n - k + 1) / static_cast<double>(k);
    most = std::max(most, at + next);
    if (next < at && at + next < most) break;
    at = next;
  }
  return most;
}

/// True if the ticks beyond (or short of) one per row are spread more evenly than by chance: runs
/// of as many rows as hold two of them on average hold one of two adjacent numbers more often. Runs
/// in which rows are missing, as when a logger is busy, do not count against this.
bool are_evenly_spread(View<double> stamps, double tick) {
  const double share = share_of_odd_ticks(stamps, tick);
  if (!(share * static_cast<double>(stamps.size() - 1) >= 12.0) || share > 0.52) return false;
  const auto rows = static_cast<std::size_t>(std::ceil(2.0 / share));
  std::vector<double> odd = odd_ticks_over(stamps, rows, tick);
  if (odd.size() < 5) return false;
  std::ranges::sort(odd);
  std::size_t most = 0;
  for (std::size_t first = 0, end = 0; first < odd.size(); ++first) {
    while (end < odd.size() && odd[end] <= odd[first] + 1.0) ++end;
    most = std::max(most, end - first);
  }
  constexpr double significant = 3.7;  // a chance of 10⁻⁴
  const auto runs = static_cast<double>(odd.size());
  // If the tick is almost the period, a missing row looks like a tick that is due to rounding.
  constexpr double almost = 0.05, nearly_all = 0.95;
  if (share < almost && static_cast<double>(most) < nearly_all * runs) return false;
  const double by_chance = of_two_adjacent(rows, share);
  return static_cast<double>(most) >
         by_chance * runs + significant * std::sqrt(by_chance * (1.0 - by_chance) * runs);
}

/// From runs without missing rows: the shortest of short ones, then of ever longer ones those that
/// agree with them.
double step_of_whole_stretches(View<double> stamps, double tick) {
  std::size_t rows = 16;
  const double shortest = quantile(rises_over(stamps, rows), 0.05).value_or(0.0);
  double step = (shortest + 0.5 * tick) / static_cast<double>(rows);
  for (; rows < stamps.size(); rows *= 2) {
    const std::vector<double> rises = rises_over(stamps, rows);
    Moments whole;
    for (const double rise : rises)
      if (std::abs(rise - static_cast<double>(rows) * step) <= 1.01 * tick) whole.add(rise);
    if (whole.count < 4 || whole.count * 4 < rises.size()) break;
    step = whole.mean / static_cast<double>(rows);
  }
  return step;
}

/// The period for which the stamps stay best in a band of one tick, among those near `about`, up to
/// a share `reach` away in either direction.
double step_of_best_band(View<double> stamps, double tick, double about, double reach) {
  constexpr int each_way = 24;
  double best = about;
  double least = std::numeric_limits<double>::infinity();
  for (int k = -each_way; k <= each_way; ++k) {
    const double step = about * (1.0 + reach * k / each_way);
    const double strain = signal::strain_in_band(stamps, step, tick);
    if (strain >= least) continue;
    least = strain;
    best = step;
  }
  return best;
}

/// A straight line through stamps against their sample numbers.
struct StampLine {
  double step = 0.0;
  double scatter = 0.0;  ///< root mean square about the line
  double width = 0.0;    ///< from the lowest to the highest residual
};

StampLine line_through(View<double> stamps, View<double> numbers) {
  const double middle = numbers.back() / 2.0, origin = stamps[stamps.size() / 2];
  const auto count = static_cast<double>(stamps.size());
  double mean = 0.0, mean_number = 0.0;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    mean_number += (numbers[k] - middle) / count;
    mean += (stamps[k] - origin) / count;
  }
  double weight = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const double number = numbers[k] - middle - mean_number;
    weight += number * number;
    sum += number * (stamps[k] - origin - mean);
  }
  StampLine out{.step = sum / weight};
  Moments off;
  for (std::size_t k = 0; k < stamps.size(); ++k)
    off.add(stamps[k] - origin - mean - (numbers[k] - middle - mean_number) * out.step);
  out.scatter = off.std();
  out.width = off.max - off.min;
  return out;
}

}  // namespace

std::optional<CoarseStamps> find_coarse_stamps(View<double> stamps,
                                               const std::vector<double>& steps,
                                               double median_step) {
  const View<double> some = beginning(stamps);
  if (!are_whole(steps, median_step) || !are_evenly_spread(some, median_step)) return std::nullopt;
  const double rough = step_of_whole_stretches(some, median_step);
  if (!(rough > 0.45 * median_step && rough < 1.6 * median_step)) return std::nullopt;
  // Rows written twice at regular intervals, as by a logger's buffer, look the same except for one
  // thing: the rounding of stamps is at most one unit of the last digit.
  const bool may_be_written_twice = rough < median_step && rough > 0.88 * median_step;
  if (may_be_written_twice && median_step > 1.001) return std::nullopt;
  const auto best = [&](std::size_t rows, double about, double reach) {
    return step_of_best_band(some.first(std::min(rows, some.size())), median_step, about, reach);
  };
  const double better = best(4096, best(1024, rough, 0.012), 1e-3);
  const double step = step_by_line(stamps, better, median_step);
  // The clock's own jitter adds to the rounding.
  const double strain = signal::strain_in_band(some, step, median_step);
  constexpr double most_of_jitter = 4.0;
  const double jitter = most_of_jitter * strain / static_cast<double>(some.size());
  return CoarseStamps{median_step, step, median_step + jitter};
}

double band_of_bursts(View<double> stamps, double step) {
  const View<double> some = beginning(stamps);
  const std::size_t rows = std::clamp<std::size_t>(some.size() / 16, 16, 256);
  std::vector<double> ranges;
  for (std::size_t from = 0; from + rows <= some.size(); from += rows) {
    Moments off;
    for (std::size_t k = from; k < from + rows; ++k)
      if (is_stamp(some[k])) off.add(some[k] - static_cast<double>(k) * step);
    ranges.push_back(off.max - off.min);
  }
  constexpr double margin = 2.0;
  return ranges.size() < 2 ? 0.0 : margin * quantile(ranges, 0.9).value_or(0.0);
}

std::optional<BurstLine> line_without_holes(View<double> stamps, double step, double band) {
  const View<double> some = beginning(stamps);
  if (some.size() < 32 || !std::ranges::all_of(some, is_stamp)) return std::nullopt;
  const std::vector<double> holed = signal::numbers_in_band(some, step, band);
  if (holed.back() == static_cast<double>(some.size() - 1)) return std::nullopt;
  std::vector<double> whole(some.size());
  std::iota(whole.begin(), whole.end(), 0.0);
  const StampLine without = line_through(some, whole);
  constexpr double as_little = 1.3, margin = 1.05;
  if (without.scatter > as_little * line_through(some, holed).scatter) return std::nullopt;
  return BurstLine{without.step, margin * without.width};
}

double step_by_line(View<double> stamps, double step, double band) {
  const View<double> some = beginning(stamps);
  if (some.size() < 3 || !std::ranges::all_of(some, is_stamp)) return step;
  const std::vector<double> numbers =
      band > 0.0 ? signal::numbers_in_band(some, step, band) : numbers_by_step(some, step);
  const double fitted = line_through(some, numbers).step;
  // A burst more or less at an end of a short recording changes the rate by some per cent.
  const double most = band > 0.0 ? 0.05 : 0.02;
  return std::abs(fitted / step - 1.0) < most ? fitted : step;
}

}  // namespace proofmass::io
