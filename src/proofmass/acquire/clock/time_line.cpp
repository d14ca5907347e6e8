#include "proofmass/acquire/clock/time_line.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace proofmass::acquire {

void DelayFloor::add(double host_s, double delay_s) {
  constexpr double stretch_s = 10.0;
  if (!now_ || host_s - since_s_ > stretch_s) {
    before_ = std::exchange(now_, delay_s);
    since_s_ = host_s;
  }
  now_ = std::min(*now_, delay_s);
}

double DelayFloor::value() const {
  if (!now_) return 0.0;
  return before_ ? std::min(*before_, *now_) : *now_;
}

void TimeLine::reopen(const SourceHead& head) {
  is_paced_ = head.is_paced;
  rate_hz_ = head.recording.time.rate_hz;
  const Clock without = rate_hz_ > 0.0 ? Clock::count : Clock::host;
  clock_ = head.has_device_clock ? Clock::device : without;
  step_ = SamplePeriod(rate_hz_ > 0.0 ? 1.0 / rate_hz_ : 0.0);
  is_new_ = true;
  is_gap_ = has_rows_;
  still_rows_ = 0;
}

double TimeLine::host_s(std::int64_t host_ns) const {
  return static_cast<double>(host_ns - first_host_ns_) * 1e-9;
}

void TimeLine::report(EventKind kind, double duration_s, std::uint64_t rows, std::string text) {
  events_->push_back({kind, Severity::warning, last_s_, duration_s, rows, std::move(text)});
}

/// From the host's clock if it shows that time has passed; else the next interval.
double TimeLine::bridged(const Arrival& arrival, std::size_t row) const {
  const double step_s = step_.step_s();
  const double next_s = last_s_ + step_s;
  if (!has_rows_) return 0.0;
  if (!is_paced_) return next_s;
  const double behind_s = static_cast<double>(arrival.rows() - 1 - row) * step_s;
  const double arrived_s = host_s(arrival.host_ns) - floor_.value() - behind_s;
  const double tolerance_s = std::max(0.05, 5.0 * step_s);
  return arrived_s > next_s + tolerance_s ? arrived_s : next_s;
}

void TimeLine::stamp(const QueueItem& item,
                     std::vector<double>& stamps_s,
                     std::vector<RecordEvent>& events) {
  const Arrival& arrival = item.arrival;
  events_ = &events;
  stamps_s.clear();
  if (!has_rows_) first_host_ns_ = arrival.host_ns;
  if (clock_ == Clock::device && is_dead(arrival)) {
    clock_ = rate_hz_ > 0.0 ? Clock::count : Clock::host;
    is_new_ = true;
    report(EventKind::clock_dead, 0.0, 0,
           fmt::format("the device's clock does not move: {}",
                       rate_hz_ > 0.0 ? fmt::format("rows are counted at {} Hz", rate_hz_)
                                      : "the time is the host's when rows arrive"));
  }
  if (clock_ == Clock::device) stamp_by_device(item, stamps_s);
  if (clock_ == Clock::count) stamp_by_count(item, stamps_s);
  if (clock_ == Clock::host) stamp_by_host(item, stamps_s);
  rows_ += arrival.rows();
  has_rows_ = true;
  is_new_ = is_gap_ = false;
  floor_.add(host_s(arrival.host_ns), host_s(arrival.host_ns) - last_s_);
}

void TimeLine::report_known(const QueueItem& item, double hole_s) {
  const std::uint64_t lost = item.arrival.lost_before;
  if (lost > 0)
    report(EventKind::lost, hole_s, lost,
           fmt::format("{} rows are lost, by the device's own count", lost));
  if (item.overrun > 0)
    report(EventKind::overrun, hole_s, item.overrun,
           fmt::format("{} rows were dropped, as the queue was full", item.overrun));
}

/// Reports the number of rows in a hole, of which `open_s` is not explained.
std::uint64_t TimeLine::report_gap(double hole_s, double open_s) {
  const double usual_s = step_.step_s();
  const double rows = usual_s > 0.0 ? std::round(open_s / usual_s) - 1.0 : 0.0;
  constexpr double most_rows = 1e15;
  const auto count = static_cast<std::uint64_t>(std::clamp(rows, 0.0, most_rows));
  const std::string missing =
      count > 0 ? fmt::format(": about {} rows are missing", count) : std::string();
  report(EventKind::gap, hole_s, count,
         fmt::format("nothing for {:.6g} s by the {} clock{}", hole_s,
                     clock_ == Clock::device ? "device's" : "host's", missing));
  return count;
}

/// Rows missing before a stamp, of which `known` by the device's own count; reports the others.
std::uint64_t TimeLine::missing_in(const QueueItem& item,
                                   double hole_s,
                                   std::uint64_t known,
                                   RowPlace place) {
  const double open_s = hole_s - static_cast<double>(known) * step_.step_s();
  const bool is_hole = clock_ == Clock::device && step_.is_hole(open_s);
  if (known == 0 && place == RowPlace::within) step_.add(hole_s);
  const bool breaks_off = place == RowPlace::after_break;
  if (!is_hole && !breaks_off) return known;
  return known + report_gap(hole_s, item.is_counted && breaks_off ? 0.0 : open_s);
}

/// Reports the rows missing before and between the current ones; advances the last stamp.
void TimeLine::report_missing(const QueueItem& item, View<double> stamps_s) {
  std::uint64_t missing = item.arrival.lost_before + item.overrun;
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    const bool is_first = i == 0 && !has_rows_;
    const double hole_s = is_first ? 0.0 : stamps_s[i] - last_s_;
    if (i == 0) report_known(item, hole_s);
    const RowPlace place = i == 0 && is_gap_ ? RowPlace::after_break
                           : is_first        ? RowPlace::first
                                             : RowPlace::within;
    rows_ += missing_in(item, hole_s, std::exchange(missing, 0), place);
    last_s_ = stamps_s[i];
  }
}

bool TimeLine::is_dead(const Arrival& arrival) {
  for (const std::int64_t ns : arrival.device_ns) {
    if (still_rows_ == 0 || ns != still_at_ns_) still_rows_ = 0;
    still_at_ns_ = ns;
    ++still_rows_;
  }
  constexpr std::size_t most_still = 16;
  return still_rows_ >= most_still;
}

/// From the device's clock, unless it steps back or into the host's future.
double TimeLine::device_stamp(const Arrival& arrival, std::size_t row) {
  std::int64_t since_ns = 0;
  const std::int64_t at_ns = arrival.device_ns[row];
  const bool is_sane = !__builtin_sub_overflow(at_ns, device_ns_, &since_ns);
  const double stamp_s = device_s_ + static_cast<double>(since_ns) * 1e-9;
  const double step_s = step_.step_s();
  const double slack_s = std::max(0.1, 5.0 * step_s);
  const double behind_s = static_cast<double>(arrival.rows() - 1 - row) * step_s;
  const double latest_s = host_s(arrival.host_ns) - floor_.value() - behind_s + slack_s;
  const bool is_ahead = is_paced_ && stamp_s > last_s_ + slack_s && stamp_s > latest_s;
  if (is_sane && stamp_s >= last_s_ && !is_ahead) return stamp_s;
  // Stamps out of order by less than an interval are not a step of the clock.
  if (is_sane && stamp_s < last_s_ && last_s_ - stamp_s < step_s) return last_s_;
  const double bridged_s = bridged(arrival, row);
  report(EventKind::clock_jump, 0.0, 0,
         fmt::format("the device's clock steps {} by {:.6g} s: the host's bridges it",
                     is_ahead || !is_sane ? "ahead" : "back", std::abs(stamp_s - bridged_s)));
  device_ns_ = at_ns;
  device_s_ = bridged_s;
  return bridged_s;
}

void TimeLine::stamp_by_device(const QueueItem& item, std::vector<double>& stamps_s) {
  const Arrival& arrival = item.arrival;
  const double before_s = last_s_;
  if (is_new_) {
    device_ns_ = arrival.device_ns.front();
    device_s_ = bridged(arrival, 0);
    last_s_ = device_s_;
  }
  for (std::size_t i = 0; i < arrival.rows(); ++i) {
    stamps_s.push_back(device_stamp(arrival, i));
    last_s_ = stamps_s.back();
  }
  last_s_ = before_s;
  report_missing(item, stamps_s);
}

void TimeLine::stamp_by_count(const QueueItem& item, std::vector<double>& stamps_s) {
  const Arrival& arrival = item.arrival;
  const std::uint64_t known = arrival.lost_before + item.overrun;
  is_gap_ = is_gap_ || item.gap_s > 0.0;
  if (is_new_ || is_gap_) {
    const double next_s = last_s_ + (static_cast<double>(known) + 1.0) / rate_hz_ + item.gap_s;
    count_s_ = has_rows_ ? std::max(next_s, is_new_ ? bridged(arrival, 0) : next_s) : 0.0;
    counted_ = 0;
  } else {
    counted_ += known;
  }
  for (std::size_t i = 0; i < arrival.rows(); ++i)
    stamps_s.push_back(count_s_ + static_cast<double>(counted_++) / rate_hz_);
  report_missing(item, stamps_s);
}

void TimeLine::stamp_by_host(const QueueItem& item, std::vector<double>& stamps_s) {
  const Arrival& arrival = item.arrival;
  const double now_s = host_s(arrival.host_ns);
  const auto rows = static_cast<double>(arrival.rows());
  const double known = static_cast<double>(arrival.lost_before + item.overrun);
  if (!has_rows_) {
    const double step_s = item.step_s;
    for (std::size_t i = 0; i < arrival.rows(); ++i)
      stamps_s.push_back(static_cast<double>(i) * step_s);
    // The last of them is the one that arrived now.
    first_host_ns_ -= static_cast<std::int64_t>(1e9 * (rows - 1.0) * step_s);
    line_.restart(stamps_s.back(), step_s);
    report_missing(item, stamps_s);
    return;
  }
  const double expected_s = line_.step_s() * (rows + known);
  is_gap_ = is_gap_ || now_s - last_s_ > expected_s + std::max(1.0, 5.0 * expected_s);
  double end_s = now_s;
  if (is_gap_ || is_new_)
    line_.restart(now_s, line_.step_s());
  else
    end_s = line_.follow(rows + known, now_s);
  end_s = std::max(end_s, last_s_);
  const double spread_s = (end_s - last_s_) / (rows + known);
  const double step_s = is_gap_ ? std::min(line_.step_s(), spread_s) : spread_s;
  for (std::size_t i = 0; i < arrival.rows(); ++i)
    stamps_s.push_back(end_s - static_cast<double>(arrival.rows() - 1 - i) * step_s);
  report_missing(item, stamps_s);
}

}  // namespace proofmass::acquire
