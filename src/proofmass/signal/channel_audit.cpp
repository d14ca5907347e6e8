#include "proofmass/signal/channel_audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace proofmass::signal {
namespace {

/// A difference between neighbouring distinct values, and how often the rarer of the two is read: a
/// value that is off the grid once weighs little.
struct Difference {
  double size = 0.0;
  double weight = 0.0;
};

std::vector<Difference> differences_of(View<double> sorted) {
  std::vector<Difference> out;
  double last_count = 0.0;
  for (std::size_t k = 0; k < sorted.size();) {
    std::size_t end = k + 1;
    while (end < sorted.size() && sorted[end] == sorted[k]) ++end;
    const auto count = static_cast<double>(end - k);
    if (k > 0) out.push_back({sorted[k] - sorted[k - 1], std::min(count, last_count)});
    last_count = count;
    k = end;
  }
  return out;
}

/// A step, and by weight how much of the differences are whole multiples of it to within 15 %.
struct GridFit {
  double step = 0.0;
  double on_grid = 0.0;
};

/// Improves on a rough step: the sum of the differences over the sum of the multiples they are.
GridFit fit_grid(const std::vector<Difference>& differences, double step) {
  GridFit fit{step, 0.0};
  for (int pass = 0; pass < 2; ++pass) {
    double sum = 0.0;
    double multiples = 0.0;
    double on_grid = 0.0;
    double all = 0.0;
    for (const auto& [size, weight] : differences) {
      all += weight;
      const double n = std::round(size / fit.step);
      if (n < 1.0 || std::abs(size / fit.step - n) > 0.15) continue;
      on_grid += weight;
      // Large gaps say little about a step that is not yet known well.
      if (n > 4.0) continue;
      sum += weight * size;
      multiples += weight * n;
    }
    fit.on_grid = on_grid / all;
    if (multiples > 0.0) fit.step = sum / multiples;
  }
  return fit;
}

bool has_range(Quantity quantity) {
  return quantity == Quantity::acceleration || quantity == Quantity::angular_rate ||
         quantity == Quantity::voltage || quantity == Quantity::counts;
}

/// Runs of equal values: those at a rail, and the longest elsewhere.
struct RailRuns {
  std::size_t samples = 0;  ///< in runs of three or more at the rail
  std::size_t runs = 0;     ///< of these
  std::size_t longest_at_rail = 0;
  std::size_t longest_elsewhere = 0;
  std::size_t beside = 0;  ///< samples near the rail, but not at it

  void add(double distance, double nearby, std::size_t run) {
    constexpr std::size_t shortest_run = 3;
    if (distance != 0.0) {
      longest_elsewhere = std::max(longest_elsewhere, run);
      beside += distance <= nearby ? run : 0;
      return;
    }
    longest_at_rail = std::max(longest_at_rail, run);
    samples += run >= shortest_run ? run : 0;
    runs += run >= shortest_run ? 1 : 0;
  }
};

/// Samples in runs of three or more at exactly `rail`, if the signal piles up there: more often
/// than in the fiftieth of the range beside it, and not just for once as a value that is held is.
std::size_t count_clipped(View<double> series, double rail, double other_rail) {
  RailRuns seen;
  for (std::size_t k = 0; k < series.size();) {
    std::size_t end = k + 1;
    while (end < series.size() && series[end] == series[k]) ++end;
    seen.add(std::abs(series[k] - rail), std::abs(rail - other_rail) / 50.0, end - k);
    k = end;
  }
  const bool is_rail = seen.runs >= 2 || seen.longest_at_rail > seen.longest_elsewhere;
  return is_rail && seen.samples > seen.beside ? seen.samples : 0;
}

void audit_clipping(const Channel& channel, ChannelAudit& out) {
  const double low = out.moments.min;
  const double high = out.moments.max;
  if (!has_range(channel.unit.quantity) || !(high > low)) return;
  // Of a handful of levels the outermost are no rails, only the ends of the noise.
  constexpr double fewest_levels = 32.0;
  if (out.lsb && high - low < fewest_levels * *out.lsb) return;
  if (high != 0.0) out.clipped += count_clipped(channel.values, high, low);
  if (low != 0.0) out.clipped += count_clipped(channel.values, low, high);
}

}  // namespace

bool is_denormal(double value) {
  return value != 0.0 && std::abs(value) < double{std::numeric_limits<float>::min()};
}

bool is_plausible(double value) {
  return std::abs(value) <= absurd_magnitude && !is_denormal(value);
}

std::optional<double> find_lsb(View<double> series) {
  constexpr std::size_t most = 1u << 18;
  const std::size_t stride = series.size() / most + 1;
  std::vector<double> values;
  for (std::size_t k = 0; k < series.size(); k += stride)
    if (is_plausible(series[k])) values.push_back(series[k]);
  std::ranges::sort(values);
  const std::vector<Difference> differences = differences_of(values);
  if (differences.empty() || (differences.size() + 1) * 2 > values.size()) return std::nullopt;
  std::vector<double> sizes;
  sizes.reserve(differences.size());
  for (const Difference& difference : differences) sizes.push_back(difference.size);
  std::ranges::sort(sizes);
  // The smallest difference is the step unless a few values are off the grid: then look higher.
  for (const double p : {0.0, 0.01, 0.05, 0.25, 0.5}) {
    const auto at = static_cast<std::size_t>(p * static_cast<double>(sizes.size() - 1));
    const GridFit fit = fit_grid(differences, sizes[at]);
    if (fit.on_grid >= 0.98) return fit.step;
  }
  return std::nullopt;
}

ChannelAudit audit_channel(const Channel& channel, const TimeBase& time) {
  ChannelAudit out;
  out.name = channel.name;
  out.unit = channel.unit;
  std::size_t run = 0;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < channel.values.size(); ++k) {
    const double x = channel.values[k];
    if (!std::isfinite(x)) {
      ++out.nonfinite;
      if (std::isinf(x)) ++out.infinite;
    } else if (std::abs(x) > absurd_magnitude) {
      ++out.absurd;
    } else if (is_denormal(x)) {
      ++out.denormal;
    } else {
      out.moments.add(x);
    }
    run = x == last ? run + 1 : 1;
    last = x;
    if (is_plausible(x) && run > out.longest_stuck) {
      out.longest_stuck = run;
      out.longest_stuck_start_s = time.at(k + 1 - run);
    }
  }
  out.lsb = find_lsb(channel.values);
  audit_clipping(channel, out);
  return out;
}

}  // namespace proofmass::signal
