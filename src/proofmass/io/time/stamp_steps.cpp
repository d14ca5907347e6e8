#include "proofmass/io/time/stamp_steps.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/time/coarse_stamps.hpp"

namespace proofmass::io {
namespace {

/// The largest divisor of the intervals up to five medians, if it is more than 1 % of the median:
/// the resolution with which the clock was read, or written.
double rounding_of(const std::vector<double>& steps, double median) {
  constexpr std::size_t most = 4096;
  std::vector<double> sorted;
  for (std::size_t i = 0; i < steps.size(); i += steps.size() / most + 1)
    if (steps[i] < 5.0 * median) sorted.push_back(steps[i]);
  std::ranges::sort(sorted);
  const double noise = 1e-6 * median;
  double smallest = 0.0;
  double previous = 0.0;
  for (const double step : sorted) {
    const double rise = step - previous;
    if (rise > noise && (smallest == 0.0 || rise < smallest)) smallest = rise;
    previous = step;
  }
  if (smallest < 0.01 * median || smallest > 0.99 * median) return 0.0;
  const auto off_grid = std::ranges::count_if(sorted, [&](double step) {
    return std::abs(std::remainder(step, smallest)) > 1e-3 * median;
  });
  return static_cast<std::size_t>(off_grid) * 100 > sorted.size() ? 0.0 : smallest;
}

/// Intervals between adjacent stamps, at most 65 536 of them spread over the file.
std::vector<double> sampled_steps(View<double> stamps) {
  constexpr std::size_t most = 1u << 16;
  std::vector<double> steps;
  for (std::size_t k = 0; k + 1 < stamps.size(); k += stamps.size() / most + 1)
    if (is_stamp(stamps[k]) && is_stamp(stamps[k + 1])) steps.push_back(stamps[k + 1] - stamps[k]);
  return steps;
}

/// The median of the steps that are longer than half as much again as this: from one burst to the
/// next, if rows come in bursts. 0 if they are less than a hundredth, and gaps.
double step_between_bursts(const std::vector<double>& steps, double per_row) {
  std::vector<double> longer;
  std::ranges::copy_if(steps, std::back_inserter(longer),
                       [&](double step) { return step > 1.5 * per_row; });
  return 100 * longer.size() < steps.size() ? 0.0 : *median(longer);
}

/// Time per row: the mean over segments of rows, without those that are outliers due to gaps; 0 if
/// there are fewer than eight. Long segments, so that bursts average out; several, so that few
/// contain gaps.
double long_run_of(View<double> stamps, const std::vector<double>& steps) {
  const std::size_t count = stamps.size() < 1024 ? 16 : 64;
  const std::size_t rows = (stamps.size() - 1) / count;
  if (rows < 4) return 0.0;
  std::vector<double> means;
  for (std::size_t i = 0; i < count; ++i) {
    const double from = stamps[i * rows];
    const double to = stamps[(i + 1) * rows];
    if (is_stamp(from) && is_stamp(to) && to > from)
      means.push_back((to - from) / static_cast<double>(rows));
  }
  if (means.size() < 8) return 0.0;
  const double middle = *median(means);
  // A segment contains whole bursts, one more or less than others.
  const double burst = 1.1 * step_between_bursts(steps, middle) / static_cast<double>(rows);
  const double near = std::max({3.0 * *robust_std(means), 0.25 * middle, burst});
  Moments usual;
  for (const double mean : means)
    if (std::abs(mean - middle) <= near) usual.add(mean);
  return usual.mean;
}

/// True if the intervals are consistent with lost rows: nine in ten are whole multiples of the
/// single interval within a fifth of it, and half of them the single interval itself.
bool are_multiples(const std::vector<double>& steps, double single) {
  std::size_t multiples = 0;
  std::size_t singles = 0;
  for (const double step : steps) {
    const double whole = std::round(step / single);
    if (whole < 1.0 || std::abs(step / single - whole) > 0.2) continue;
    ++multiples;
    if (whole == 1.0) ++singles;
  }
  return multiples * 10 >= steps.size() * 9 && singles * 2 >= steps.size();
}

/// The same for stamps with jitter: the longer intervals are multiples of the single one on
/// average, as closely as its own scatter σ allows. The mean of e^(2πi step/single) is then
/// e^(−2π²σ²), at the phase 0. Source: K. V. Mardia, P. E. Jupp, Directional Statistics (2000),
/// section 3.5.7.
bool are_multiples_with_jitter(const std::vector<double>& steps, double single) {
  constexpr std::size_t fewest = 20;
  constexpr double least_share = 0.5, of_expected = 0.6, largest_phase = 0.1, most_jitter = 0.3;
  Moments singles;
  std::complex<double> sum;
  std::size_t longer = 0;
  for (const double step : steps) {
    const double periods = step / single;
    if (std::abs(periods - 1.0) <= 0.5) singles.add(periods);
    if (periods <= 1.5) continue;
    sum += std::polar(1.0, 2.0 * std::numbers::pi * periods);
    ++longer;
  }
  if (static_cast<double>(singles.count) < least_share * static_cast<double>(steps.size()))
    return false;
  const double jitter = singles.std();
  if (longer < fewest || jitter > most_jitter) return false;
  const std::complex<double> mean = sum / static_cast<double>(longer);
  const double expected = std::exp(-2.0 * square(std::numbers::pi * jitter));
  return std::abs(std::arg(mean)) < 2.0 * std::numbers::pi * largest_phase &&
         std::abs(mean) > of_expected * expected;
}

/// The median of the intervals within half an interval of it: that of all is too long if rows are
/// lost and stamps jitter, because each loss removes an interval from the lower half.
double ordinary_median(const std::vector<double>& steps, double median_step) {
  double ordinary = median_step;
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<double> near;
    std::ranges::copy_if(steps, std::back_inserter(near),
                         [&](double step) { return std::abs(step - ordinary) <= 0.5 * ordinary; });
    const double next = *median(near);
    if (next == ordinary) break;
    ordinary = next;
  }
  return ordinary;
}

/// The mean of the intervals about this one: within half of it, and a tick at least.
double ordinary_mean(const std::vector<double>& steps, double middle, double tick) {
  const double reach = std::max(0.5 * middle, 1.001 * tick);
  Moments near;
  for (const double step : steps)
    if (std::abs(step - middle) <= reach) near.add(step);
  return near.mean;
}

/// The period from a line through the stamps, if it equals the single one to within the uncertainty
/// due to jitter, or the bias of a median among lost rows; else 0. Only for stamps with jitter.
double step_by_jittered_line(View<double> stamps,
                             const std::vector<double>& steps,
                             double single,
                             bool is_rounded) {
  constexpr double least_jitter = 0.01, bias = 0.005;
  std::vector<double> near;
  std::ranges::copy_if(steps, std::back_inserter(near),
                       [&](double step) { return std::abs(step - single) <= 0.5 * single; });
  // That of rounded intervals may be 0 by the robust estimate.
  const double jitter = is_rounded ? moments(near).std() : *robust_std(near);
  if (jitter < least_jitter * single || near.size() * 2 < steps.size()) return 0.0;
  // Source: asymptotic variance of the median, π/2 times that of the mean.
  const double std = 1.2533 * jitter / std::sqrt(static_cast<double>(near.size()));
  const double line = step_by_line(stamps, step_by_line(stamps, single, 0.0), 0.0);
  return std::abs(line - single) <= std::max(3.0 * std, bias * single) ? line : 0.0;
}

bool come_in_bursts(const StampSteps& out, const std::vector<double>& steps) {
  const double single = out.single;
  if (out.long_run <= 0.0 || std::abs(out.long_run / single - 1.0) <= 0.05) return false;
  if (out.long_run < single) return out.repeated > 0.12;
  // With random loss, half of the lost rows are not followed by another: the long run is less than
  // two intervals.
  if (out.long_run > 3.0 * single) return true;
  return !are_multiples(steps, single) && !are_multiples_with_jitter(steps, single);
}

// Rounded stamps: by the regular steps, or a band where single steps are not conclusive.
void measure_rounding(View<double> stamps, const std::vector<double>& steps, StampSteps& out) {
  out.rounding = rounding_of(steps, out.median);
  if (out.rounding == 0.0) {
    if (const auto coarse = find_coarse_stamps(stamps, steps, out.median)) {
      out.rounding = coarse->tick;
      out.coarse = coarse->step;
      out.band = coarse->band;
    }
  }
  Moments near;
  for (const double step : steps)
    if (std::abs(step - out.median) <= 1.001 * out.rounding) near.add(step);
  out.mean_near = near.count > 0 ? near.mean : out.median;
  out.single = out.rounding > 0.0 ? out.mean_near : ordinary_median(steps, out.median);
}

void measure_bursts(View<double> stamps, StampSteps& out) {
  out.band = band_of_bursts(stamps, out.long_run);
  if (!(out.band > 0.0)) return;
  // Twice, since with a step some per cent off rows may seem to be missing.
  for (int pass = 0; pass < 2; ++pass) out.long_run = step_by_line(stamps, out.long_run, out.band);
  if (const auto whole = line_without_holes(stamps, out.long_run, out.band)) {
    out.long_run = whole->step;
    out.band = whole->band;
  }
}

void refine_single(View<double> stamps, const std::vector<double>& steps, StampSteps& out) {
  // The median of rounded intervals is one of a few ticks.
  const bool is_rounded = out.rounding > 0.0;
  const double usual = is_rounded ? ordinary_mean(steps, out.median, out.rounding) : out.single;
  const double line = step_by_jittered_line(stamps, steps, usual, is_rounded);
  if (line > 0.0) out.single = line;
}

}  // namespace

StampSteps measure_steps(View<double> stamps) {
  StampSteps out;
  const std::vector<double> all = sampled_steps(stamps);
  if (all.empty()) return out;
  const auto fraction = [&](auto is_such) {
    return static_cast<double>(std::ranges::count_if(all, is_such)) /
           static_cast<double>(all.size());
  };
  out.middle = *median(all);
  out.ascending = fraction([](double step) { return step >= 0.0; });
  out.repeated = fraction([](double step) { return step == 0.0; });
  std::vector<double> up;
  std::ranges::copy_if(all, std::back_inserter(up), [](double step) { return step > 0.0; });
  if (up.empty()) return out;
  out.median = *median(up);
  measure_rounding(stamps, up, out);
  out.long_run = long_run_of(stamps, all);
  out.in_bursts = out.coarse == 0.0 && come_in_bursts(out, all);
  if (out.in_bursts)
    measure_bursts(stamps, out);
  else if (out.coarse == 0.0)
    refine_single(stamps, up, out);
  return out;
}

bool are_regular(View<double> stamps, double usual) {
  // Branch-free, so that the compiler can vectorise it.
  std::size_t odd = 0;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    const double rise = stamps[k] - stamps[k - 1];
    odd += static_cast<std::size_t>(!(rise >= 0.0)) + static_cast<std::size_t>(!(rise <= usual));
  }
  return odd == 0;
}

double uniform_rate_hz(View<double> stamps_s) {
  if (stamps_s.size() < 3 || !(stamps_s.back() > 0.0)) return 0.0;
  const auto fits = [&](double rate_hz) {
    for (std::size_t k = 0; k < stamps_s.size(); ++k)
      if (static_cast<double>(k) / rate_hz != stamps_s[k]) return false;
    return true;
  };
  const double rough_hz = static_cast<double>(stamps_s.size() - 1) / stamps_s.back();
  for (int digits = 1; digits <= 17; ++digits) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), rough_hz,
                                   std::chars_format::scientific, digits);
    double rate_hz = 0.0;
    std::from_chars(text.data(), end.ptr, rate_hz);
    if (rate_hz > 0.0 && std::isfinite(rate_hz) && fits(rate_hz)) return rate_hz;
  }
  return 0.0;
}

}  // namespace proofmass::io
