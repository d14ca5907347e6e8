#include "proofmass/io/time/stamps.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/text/wording.hpp"
#include "proofmass/io/time/stamp_lookahead.hpp"

namespace proofmass::io {
namespace {

constexpr double hour_s = 3600.0;
constexpr double ten_years_s = 3.2e8;

}  // namespace

void SampleTally::add(std::size_t sample) {
  if (++count <= 5) first.push_back(sample);
}

std::string SampleTally::where(std::size_t first_line) const {
  const std::string some = places(first, first_line);
  return count > first.size() ? fmt::format("{} and {} more", some, count - first.size()) : some;
}

std::optional<std::size_t> StampMender::first_good(View<double> stamps, const StampRules& rules) {
  // If none of this many can be the first, the next number is used.
  constexpr std::size_t most_bad_at_first = 64;
  const WrapFinder wraps(rules.unit_s);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    if (!is_stamp(stamps[k])) continue;
    StampLookahead next(stamps, k, 0.0);
    next.unroll(stamps[k], wraps, rules.origin, rules.usual);
    const auto is_near = [&](double stamp) {
      return stamp >= stamps[k] && stamp - stamps[k] < 1e4 * rules.usual;
    };
    if (k > most_bad_at_first || next.count() == 0 || next.most_are(is_near)) return k;
  }
  return std::nullopt;
}

double StampMender::rows_since_last(std::size_t k) const {
  return static_cast<double>(row_ + k - last_->row);
}

/// True if the instrument's counter shows that no row is missing before row k.
bool StampMender::counts_on(const Rows& rows, std::size_t k) const {
  return rows.counter.empty() || rows.counter[k] - last_->count <= 1.5 * rows_since_last(k);
}

/// Judges a stamp below the last good one: a single outlier, or permanent, and the reason.
StampMender::Judgement StampMender::judge_fall(const Rows& rows, std::size_t k) const {
  const double reading = rows.stamps[k];
  const double stamp = reading + shift_;
  const StampLookahead next(rows.stamps, k, shift_);
  const auto is_back = [&](double other) { return other >= last_->stamp; };
  if (next.count() > 0 && next.most_are(is_back)) return {Event::bad};
  const double usual = rules_.usual * rows_since_last(k);
  if (const auto wrap =
          wraps_.find(rules_.origin + last_->reading, rules_.origin + reading, usual, seen_))
    return {Event::wrap, shift_ + wraps_[*wrap].range(), wrap};
  const double hour = hour_s / rules_.unit_s;
  const double without = stamp + hour - last_->stamp;
  // Intervals of a computer's clock are late by some hundredths of a second.
  if (rules_.has_summer_time && without >= 0.0 && without <= usual + 0.1 / rules_.unit_s)
    return {Event::hour, shift_ + hour};
  // One or two stamps at the very end are not sufficient to conclude that the clock was set.
  if (next.count() < 2) return {Event::bad};
  return {Event::restart, last_->stamp + rules_.nominal * rows_since_last(k) - reading};
}

/// Judges a stamp later than a usual interval: an outlier, a clock that was set, or a gap.
StampMender::Judgement StampMender::judge_leap(const Rows& rows, std::size_t k) const {
  const double reading = rows.stamps[k];
  const double stamp = reading + shift_;
  StampLookahead next(rows.stamps, k, shift_);
  next.unroll(stamp, wraps_, rules_.origin - shift_, rules_.usual);
  if (next.leave_behind(stamp, last_->stamp, rules_.usual)) return {Event::bad};
  const double rise = stamp - last_->stamp;
  const double nominal = rules_.nominal * rows_since_last(k);
  if (rise * rules_.unit_s > ten_years_s) {
    if (next.count() < 2) return {Event::bad};
    return {Event::setting, last_->stamp + nominal - reading};
  }
  const double hour = hour_s / rules_.unit_s;
  const bool is_hour = rise >= hour && rise - hour <= rules_.usual * rows_since_last(k);
  // With a slow logger, the rows of a whole hour may be missing.
  const bool is_fast = rules_.usual * rules_.unit_s < 30.0;
  if (rules_.has_summer_time && is_hour && is_fast && next.go_on(stamp, rules_.usual) &&
      counts_on(rows, k))
    return {Event::hour, shift_ - hour};
  return {Event::none, shift_};
}

StampMender::Judgement StampMender::judge(const Rows& rows, std::size_t k) const {
  if (!is_stamp(rows.stamps[k])) return {Event::bad};
  if (!last_) return {Event::none, shift_};
  const double rise = rows.stamps[k] + shift_ - last_->stamp;
  if (rise >= 0.0 && rise <= rules_.usual * rows_since_last(k)) return {Event::none, shift_};
  if (!rows.is_end && k + window > rows.stamps.size()) return {Event::undecided};
  return rise < 0.0 ? judge_fall(rows, k) : judge_leap(rows, k);
}

void StampMender::report(const Judgement& as, double reading, std::size_t row) {
  switch (as.event) {
    case Event::wrap: {
      if (done_.wraps.count == 0) done_.wrapped = wraps_[*as.wrap].words;
      done_.wraps.add(row);
      const double rise = reading + as.shift - last_->stamp;
      if (rise > rules_.usual * static_cast<double>(row - last_->row))
        done_.longest_wrap_gap = std::max(done_.longest_wrap_gap, rise);
      seen_ = as.wrap;
      break;
    }
    case Event::hour:
      done_.hours.add(row);
      if (as.shift > shift_) ++done_.hours_back;
      break;
    case Event::restart:
      if (done_.restarts.count == 0) {
        done_.fell_from = rules_.origin + last_->reading;
        done_.fell_to = rules_.origin + reading;
      }
      done_.restarts.add(row);
      break;
    case Event::setting:
      done_.settings.add(row);
      break;
    default:
      break;
  }
}

void StampMender::accept(const Rows& rows, std::size_t k, const Judgement& as) {
  const double reading = rows.stamps[k];
  report(as, reading, row_ + k);
  shift_ = as.shift;
  rows.stamps[k] = reading + shift_;
  last_ = {row_ + k, reading, rows.stamps[k], rows.counter.empty() ? 0.0 : rows.counter[k]};
}

/// The rows from the bad row k up to the next good one.
StampMender::Stretch StampMender::stretch_from(const Rows& rows, std::size_t k) const {
  Stretch out{k, k + 1};
  for (; out.end < rows.stamps.size() && out.end - k < longest_stretch; ++out.end) {
    const Judgement next = judge(rows, out.end);
    if (next.event == Event::bad) continue;
    out.is_open = next.event == Event::undecided;
    out.right = rows.stamps[out.end] + next.shift;
    return out;
  }
  out.is_open = !rows.is_end && out.end - k < longest_stretch;
  return out;
}

void StampMender::place(const Rows& rows, const Stretch& stretch) {
  for (std::size_t k = stretch.first; k < stretch.end; ++k) {
    if (is_stamp(rows.stamps[k]) && rows.stamps[k] + shift_ < last_->stamp) ++done_.backwards;
    done_.samples.add(row_ + k);
    const double behind = rows_since_last(k);
    if (!stretch.right) {
      rows.stamps[k] = last_->stamp + behind * rules_.nominal;
      continue;
    }
    double fraction = behind / rows_since_last(stretch.end);
    if (!rows.counter.empty()) {
      const double count = rows.counter[k];
      const double end = rows.counter[stretch.end];
      if (last_->count < count && count < end) {
        fraction = (count - last_->count) / (end - last_->count);
        ++done_.by_counter;
      }
    }
    rows.stamps[k] = std::lerp(last_->stamp, *stretch.right, fraction);
  }
}

/// Assigns times to the rows before the first valid one; returns their number.
std::size_t StampMender::place_before_first(const Rows& rows) {
  std::size_t k = 0;
  for (; k < rows.stamps.size() && row_ + k < rules_.first_good; ++k) {
    const double ahead = static_cast<double>(rules_.first_good - row_ - k);
    rows.stamps[k] = rules_.first_stamp - ahead * rules_.nominal;
    done_.samples.add(row_ + k);
  }
  return k;
}

/// True if `count` rows from k continue at the usual interval; they are then final.
bool StampMender::pass_regular(const Rows& rows, std::size_t k, std::size_t count) {
  const std::span<double> stamps = rows.stamps.subspan(k, count);
  if (!is_stamp(stamps.front())) return false;
  if (last_) {
    const double rise = stamps.front() + shift_ - last_->stamp;
    if (!(rise >= 0.0 && rise <= rules_.usual)) return false;
  }
  if (!are_regular(stamps, rules_.usual)) return false;
  const double reading = stamps.back();
  if (shift_ != 0.0)
    for (double& stamp : stamps) stamp += shift_;
  last_ = {row_ + k + count - 1, reading, stamps.back(),
           rows.counter.empty() ? 0.0 : rows.counter[k + count - 1]};
  return true;
}

std::size_t StampMender::fold(std::span<double> stamps, View<double> counter, bool is_end) {
  // Long enough to be fast, short enough that one outlier affects few rows.
  constexpr std::size_t stretch_rows = 1024;
  const Rows rows{stamps, counter, is_end};
  std::size_t k = place_before_first(rows);
  for (std::size_t next_try = k; k < stamps.size();) {
    if (k >= next_try) {
      const std::size_t count = std::min(stretch_rows, stamps.size() - k);
      next_try = k + count;
      if (pass_regular(rows, k, count)) {
        k += count;
        continue;
      }
    }
    const Judgement here = judge(rows, k);
    if (here.event == Event::undecided) break;
    if (here.event != Event::bad) {
      accept(rows, k++, here);
      continue;
    }
    const Stretch stretch = stretch_from(rows, k);
    if (stretch.is_open) break;
    place(rows, stretch);
    k = stretch.end;
  }
  row_ += k;
  return k;
}

}  // namespace proofmass::io
