#include "proofmass/io/time/running_time.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/stamp_unit.hpp"
#include "proofmass/io/text/wording.hpp"
#include "proofmass/io/time/notes.hpp"

namespace proofmass::io {
namespace {

/// Seconds from a value in `unit_s`: by division if the unit is a decimal fraction, so that 8333 µs
/// is the same double as "0.008333".
double in_seconds(double figure, double unit_s) {
  return unit_s < 1.0 ? figure / std::round(1.0 / unit_s) : figure * unit_s;
}

/// The time of the first sample since 1970 (or the clock's own origin); nullopt beyond ±292 years.
std::optional<std::int64_t> start_of(const StampOrigin& origin, double first, double unit_s) {
  const auto start_ns = origin.ns(unit_s);
  const double later_ns = first * unit_s * 1e9;
  if (!start_ns || !(std::abs(later_ns) < 9e18)) return std::nullopt;
  std::int64_t out = 0;
  if (__builtin_add_overflow(*start_ns, std::int64_t{std::llround(later_ns)}, &out))
    return std::nullopt;
  return out;
}

/// Note on stamps if a rate was given: a warning if they contradict it.
Note note_on_unused(const StampColumn& stamps, double rate_hz) {
  const StampSteps steps = measure_steps(stamps.values);
  const bool is_count = !stamps.is_named && steps.median == 1.0;
  if (steps.is_of_clock() && steps.ascending >= 0.8 && !is_count) {
    constexpr double most_off = 0.05;
    const double found_hz =
        1.0 / in_seconds(steps.nominal(), unit_of(stamps, steps.nominal()).unit_s);
    if (std::abs(found_hz / rate_hz - 1.0) > most_off)
      return {Severity::warning,
              fmt::format("{}: its stamps say {} Hz and are not used, as a rate of {} Hz was given",
                          stamps.name, in_words(found_hz), in_words(rate_hz))};
  }
  return {Severity::info,
          fmt::format("{}: its stamps are not used, as a rate was given", stamps.name)};
}

}  // namespace

RunningTimeBase::RunningTimeBase(const TimeEvidence& first_rows, const ReadOptions& options)
    : first_line_(first_rows.first_line),
      counter_name_(first_rows.counter_name),
      header_rate_hz_(first_rows.header_rate_hz) {
  const auto& stamps = first_rows.stamps;
  if (options.rate_hz) {
    decide_on_rate(first_rows, *options.rate_hz);
    if (stamps) decisions_.push_back(note_on_unused(*stamps, *options.rate_hz));
    return;
  }
  if (stamps) decide_on_stamps(first_rows);
  if (base_.source == TimeSource::stamps) return;
  if (header_rate_hz_) {
    decide_on_rate(first_rows, *header_rate_hz_);
    decisions_.push_back({Severity::info, fmt::format("rate of {} Hz, as the file says",
                                                      in_words(*header_rate_hz_))});
  } else if (first_rows.samples > 1) {
    decisions_.push_back(
        {Severity::warning, "no time column and no rate: samples are numbered", {Advice{"rate"}}});
  }
}

void RunningTimeBase::decide_on_stamps(const TimeEvidence& rows) {
  const StampColumn& stamps = *rows.stamps;
  const StampSteps steps = measure_steps(stamps.values);
  const bool is_count = !stamps.is_named && steps.median == 1.0;
  if (!steps.is_of_clock() || steps.ascending < 0.8 || is_count) {
    rejected_ = true;
    decisions_.push_back(
        {Severity::warning, fmt::format("{}: is not a time base, as it {}", stamps.name,
                                        is_count ? "counts in ones" : "does not ascend")});
    return;
  }
  const StampUnit unit = unit_of(stamps, steps.nominal());
  if (unit.note) decisions_.push_back(*unit.note);
  unit_s_ = unit.unit_s;
  StampRules rules{.nominal = steps.nominal(),
                   .usual = steps.usual(),
                   .origin = stamps.origin.value(),
                   .unit_s = unit.unit_s,
                   .has_summer_time = unit.is_calendar && stamps.clock != StampClock::zoned};
  rules.first_good = StampMender::first_good(stamps.values, rules).value_or(0);
  rules.first_stamp = stamps.values[rules.first_good];
  first_ = rules.first_stamp - static_cast<double>(rules.first_good) * rules.nominal;
  mender_ = StampMender(rules);
  base_.source = TimeSource::stamps;
  base_.channel = stamps.name;
  base_.start_ns = start_of(unit.origin, first_, unit_s_);
  if (are_regular(stamps.values, rules.usual)) {
    take_rate(steps);
    return;
  }
  // The rate of the resulting stamps, from their beginning.
  constexpr std::size_t most = std::size_t{1} << 16;
  const std::size_t from = std::min(rules.first_good, stamps.values.size());
  const auto begin = stamps.values.begin() + static_cast<std::ptrdiff_t>(from);
  std::vector<double> some(
      begin, begin + static_cast<std::ptrdiff_t>(std::min(most, stamps.values.size() - from)));
  rules.first_good = 0;
  static_cast<void>(StampMender(rules).fold(some, {}, true));
  const StampSteps mended = measure_steps(some);
  take_rate(mended.is_of_clock() ? mended : steps);
}

void RunningTimeBase::take_rate(const StampSteps& steps) {
  base_.rate_hz = 1.0 / in_seconds(steps.nominal(), unit_s_);
  base_.band_s = in_seconds(steps.band, unit_s_);
  rate_notes_ = notes_on_rate(base_, steps, unit_s_, header_rate_hz_);
}

void RunningTimeBase::decide_on_rate(const TimeEvidence& rows, double rate_hz) {
  base_.rate_hz = rate_hz;
  base_.source = TimeSource::given_rate;
  if (!counts_samples(rows.counter)) return;
  base_.source = TimeSource::counter;
  base_.channel = rows.counter_name;
  counted_ = CounterClock(rate_hz);
}

void RunningTimeBase::to_seconds(std::span<double> stamps) const {
  if (first_ == 0.0 && unit_s_ == 1.0) return;
  for (double& stamp : stamps) stamp = in_seconds(stamp - first_, unit_s_);
}

void RunningTimeBase::update_counts() {
  const MendedStamps& done = mender_.done();
  base_.mended = done.samples.count + done.hours.count;
  base_.mended_backwards = done.backwards + done.hours_back + done.restarts.count;
}

std::size_t RunningTimeBase::mend(std::span<double> stamps, View<double> counter, bool is_end) {
  PM_EXPECTS(has_stamps());
  if (base_.source == TimeSource::counter) {
    PM_EXPECTS(counter.size() == stamps.size());
    counted_.place(counter, stamps);
    return stamps.size();
  }
  PM_EXPECTS(counter.empty() || counter.size() == stamps.size());
  const std::size_t settled = mender_.fold(stamps, counter, is_end);
  to_seconds(stamps.first(settled));
  update_counts();
  return settled;
}

std::vector<Note> RunningTimeBase::notes(std::size_t first_line) const {
  std::vector<Note> out = decisions_;
  const auto add = [&](std::vector<Note> more) {
    std::ranges::move(more, std::back_inserter(out));
  };
  if (base_.source == TimeSource::counter) add(notes_on_counter(counter_name_, counted_));
  if (base_.source != TimeSource::stamps) return out;
  add(notes_on_mending(mender_.done(), {base_.channel, counter_name_, unit_s_, first_line}));
  add(rate_notes_);
  return out;
}

}  // namespace proofmass::io
