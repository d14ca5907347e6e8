#include "proofmass/io/lvm/time.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::lvm {
namespace {

double seconds_between(const std::optional<std::int64_t>& from,
                       const std::optional<std::int64_t>& to) {
  std::int64_t ns = 0;
  if (!from || !to || __builtin_sub_overflow(*to, *from, &ns)) return 0.0;
  return static_cast<double>(ns) * 1e-9;
}

double duration_s(const Rows& segment) {
  return static_cast<double>(segment.count) * segment.clock.delta_x;
}

/// Start of the segments, in seconds from the first one's Date and Time.
std::vector<double> starts_of(const Table& table, Timing& timing) {
  std::vector<double> starts;
  std::size_t counted_on = 0;
  const Clock& first = table.segments.front().clock;
  for (std::size_t i = 0; i < table.segments.size(); ++i) {
    const Clock& clock = table.segments[i].clock;
    double start_s = seconds_between(first.start_ns, clock.start_ns) + clock.x0;
    if (i > 0) {
      const double expected_s = starts[i - 1] + duration_s(table.segments[i - 1]);
      const double slack_s = 1.5 * clock.delta_x;
      if (std::abs(start_s - expected_s) > slack_s && std::abs(clock.x0 - expected_s) <= slack_s) {
        start_s = clock.x0;
        ++counted_on;
      }
    }
    starts.push_back(start_s);
  }
  if (counted_on > 0)
    timing.notes.push_back({Severity::info, fmt::format("X0 counts from the first segment's start "
                                                        "in {} of {} segments",
                                                        counted_on, table.segments.size())});
  return starts;
}

/// The period of a segment from the start of the next one, if it equals Delta_X before rounding.
double step_of(const Table& table, const std::vector<double>& starts_s, std::size_t i) {
  const Rows& segment = table.segments[i];
  const double stated_s = segment.clock.delta_x;
  if (i + 1 == starts_s.size() || segment.count == 0) return stated_s;
  const double step_s = (starts_s[i + 1] - starts_s[i]) / static_cast<double>(segment.count);
  return std::abs(step_s - stated_s) <= 1.01 * segment.clock.delta_half_unit ? step_s : stated_s;
}

/// One period for all rows, if the segments are consecutive without gaps.
std::optional<double> common_step(const Table& table, const std::vector<double>& starts_s) {
  const Clock& clock = table.segments.front().clock;
  if (!(clock.delta_x > 0.0)) return std::nullopt;
  double step_s = clock.delta_x;
  if (table.segments.size() > 1) {
    const auto rows = static_cast<double>(table.rows() - table.segments.back().count);
    const double mean_s = (starts_s.back() - starts_s.front()) / rows;
    const double slack_s = 1.01 * clock.delta_half_unit;
    if (!(std::abs(mean_s - step_s) <= slack_s)) return std::nullopt;
    // They differ only by the rounding of Delta_X, or match exactly.
    double row = 0.0;
    bool fits_stated = true;
    bool fits_mean = true;
    for (std::size_t i = 0; i < starts_s.size(); ++i) {
      if (table.segments[i].clock.delta_x != step_s) return std::nullopt;
      const double at_s = starts_s[i] - starts_s[0];
      fits_stated = fits_stated && std::abs(at_s - row * step_s) <= 0.01 * step_s;
      fits_mean = fits_mean && std::abs(at_s - row * mean_s) <= 0.25 * step_s;
      row += static_cast<double>(table.segments[i].count);
    }
    if (!fits_stated && !fits_mean) return std::nullopt;
    if (!fits_stated) step_s = mean_s;
  }
  return step_s;
}

void note_step(const Table& table, Timing& timing) {
  const Clock& clock = table.segments.front().clock;
  if (!(clock.delta_x > 0.0)) {
    timing.notes.push_back({Severity::warning, "no Delta_X above 0: the rate is not known"});
    return;
  }
  const double share = clock.delta_half_unit / clock.delta_x;
  if (timing.rate_hz && *timing.rate_hz == 1.0 / clock.delta_x && share > 1e-6)
    timing.notes.push_back(
        {Severity::info,
         fmt::format("Delta_X is written as {} s: the rate {} Hz is known to ±{} % only",
                     table.channels.front().delta_text, in_words(*timing.rate_hz),
                     in_words(100.0 * share))});
}

}  // namespace

Timing timing_of(const Table& table) {
  Timing timing;
  timing.start_ns = table.segments.front().clock.start_ns;
  timing.starts_s = starts_of(table, timing);
  if (table.x_column) {
    for (std::size_t i = 0; i < table.segments.size(); ++i)
      timing.starts_s[i] -= table.segments[i].clock.x0;
    return timing;
  }
  if (const auto step_s = common_step(table, timing.starts_s)) timing.rate_hz = 1.0 / *step_s;
  for (std::size_t i = 0; i < table.segments.size(); ++i)
    timing.steps_s.push_back(step_of(table, timing.starts_s, i));
  note_step(table, timing);
  if (table.segments.size() > 1)
    timing.notes.push_back(
        {Severity::info, fmt::format("{} segments are one table{}", table.segments.size(),
                                     timing.rate_hz ? ", each follows the one before without a gap"
                                                    : ": each row has its segment's time")});
  return timing;
}

}  // namespace proofmass::io::lvm
