#include "proofmass/signal/audit/timing_audit.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"

namespace proofmass::signal {

void RunningTiming::add(View<double> stamps_s) {
  if (stamps_s.empty()) return;
  if (stamps_ == 0) first_s_ = stamps_s.front();
  if (rate_hz_ > 0.0) {
    if (stamps_ > 0) add_step(stamps_s[0] - last_s_);
    const StepStatistics steps = step_statistics(stamps_s, 1.0 / rate_hz_);
    const double noticed = square(1e-3 / rate_hz_) * static_cast<double>(stamps_s.size());
    if (steps.regular) {
      in_whole_steps_ = in_whole_steps_ && steps.squares <= noticed;
      squares_ += steps.squares;
      regular_ += stamps_s.size() - 1;
    } else {
      for (std::size_t k = 1; k < stamps_s.size(); ++k) add_step(stamps_s[k] - stamps_s[k - 1]);
    }
  }
  stamps_ += stamps_s.size();
  last_s_ = stamps_s.back();
  if (rate_hz_ > 0.0) {
    recent_.insert(recent_.end(), stamps_s.begin(), stamps_s.end());
    holes_.add(stamps_s, fresh_);
    take_holes();
  }
}

// Converts the holes found by now to gaps; drops the stamps that cannot contain another.
void RunningTiming::take_holes() {
  for (const Hole& hole : fresh_) add_gap(gap_at(hole));
  take_numbers();
  fresh_.clear();
  const std::size_t kept = std::min(recent_.size(), stamps_ - numbered_ + 1);
  recent_.erase(recent_.begin(), recent_.end() - static_cast<std::ptrdiff_t>(kept));
}

// Processes the samples for which the number missing before them is determined.
void RunningTiming::take_numbers() {
  const std::size_t first = stamps_ - recent_.size();
  auto hole = fresh_.begin();
  for (; numbered_ < holes_.decided(); ++numbered_) {
    if (hole != fresh_.end() && hole->before == numbered_) {
      next_number_ += static_cast<double>(hole++->missing);
      unbroken_ = 0;
    } else if (numbered_ > 0 && band_s_ == 0.0) {
      note_stall(recent_[numbered_ - 1 - first], recent_[numbered_ - first]);
    }
    line_.add(next_number_, recent_[numbered_ - first]);
    next_number_ += 1.0;
    longest_unbroken_ = std::max(longest_unbroken_, ++unbroken_);
  }
}

void RunningTiming::note_stall(double before_s, double stamp_s) {
  constexpr double longest_step = 3.0;
  const double interval_s = stamp_s - before_s;
  if (!(interval_s * rate_hz_ > longest_step)) return;
  ++found_.stalls;
  if (interval_s <= found_.longest_stall_s) return;
  found_.longest_stall_s = interval_s;
  found_.longest_stall_start_s = before_s;
}

// The rate of the fitted line where single intervals show what is missing, it is that of the first
// and last stamp, too, and it differs significantly from the regular step's, which is a whole
// number of ticks of the stamps. Its standard deviation contains the slope that is possible in the
// part of a band that the rounded stamps do not fill, and what remains between the two rates. If
// all intervals are whole numbers of nominal periods and some rows are missing by them, the stamps
// may be rounded to a period. Then up to one row in the longest segment without a hole may not be
// missing, and the rate may be that much lower. Samples that may be missing or not add to the
// number that the duration contains.
void RunningTiming::take_rate(TimingAudit& out) const {
  constexpr double significant = 3.0, rounding = 1e-6, steady = 1e-4;
  const auto line = line_.rate();
  if (!line) return;
  const double least_hz = std::max(significant * line->std_hz, rounding * rate_hz_);
  const bool may_be_rounded = in_whole_steps_ && holes_.hole_count() > 0;
  const bool is_steady = std::abs(line->hz - holes_.grid().rate_hz) <= steady * rate_hz_;
  const bool is_line = band_s_ == 0.0 && !may_be_rounded && is_steady;
  if (is_line && std::abs(line->hz - rate_hz_) > least_hz) out.rate_hz = line->hz;
  double variance = square(line->std_hz) + square(line->hz - out.rate_hz);
  if (last_s_ > first_s_)
    variance += square(rate_hz_ * holes_.unfilled_s() / (last_s_ - first_s_)) / 3.0;
  if (may_be_rounded) variance += square(rate_hz_ / static_cast<double>(longest_unbroken_)) / 3.0;
  variance += square(rate_hz_ * holes_.missing_std() / next_number_);
  const double std_hz = std::sqrt(variance);
  // Below this it is floating-point rounding.
  if (std_hz >= 1e-12 * rate_hz_) out.rate_std_hz = std_hz;
}

// As long as between the two stamps, but as the number of samples says where these differ by
// jitter.
Gap RunningTiming::gap_at(const Hole& hole) const {
  constexpr double clear = 0.25, jitter = 1.0;
  const std::size_t at = hole.before - (stamps_ - recent_.size());
  const double by_stamps_s = recent_[at] - recent_[at - 1];
  const double by_samples_s = static_cast<double>(hole.missing + 1) / rate_hz_;
  const double periods = std::abs(by_stamps_s - by_samples_s) * rate_hz_;
  const bool is_jitter = band_s_ > 0.0 || (periods > clear && periods < jitter);
  return {recent_[at - 1], is_jitter ? by_samples_s : by_stamps_s};
}

void RunningTiming::add_gap(const Gap& gap) {
  ++found_.gap_count;
  if (found_.gaps.size() < most_listed) found_.gaps.push_back(gap);
  if (gap.duration_s > found_.longest_gap.duration_s) found_.longest_gap = gap;
}

void RunningTiming::add_step(double step_s) {
  const double nominal_s = 1.0 / rate_hz_;
  const double deviation_s = step_s - nominal_s;
  // The nominal period may be off by 10⁻³, and so are its multiples.
  if (std::abs(std::remainder(step_s, nominal_s)) > 1e-3 * std::max(std::abs(step_s), nominal_s))
    in_whole_steps_ = false;
  if (step_s < 0.0) ++found_.backwards;
  if (step_s == 0.0) ++found_.repeated;
  if (!(std::abs(deviation_s) <= std::max(0.5 * nominal_s, band_s_))) return;
  squares_ += deviation_s * deviation_s;
  ++regular_;
}

TimingAudit RunningTiming::finish(const TimeBase& time) {
  if (stamps_ > 1 && rate_hz_ > 0.0) {
    holes_.finish(fresh_);
    take_holes();
    found_.long_run_hz = holes_.grid().rate_hz;
  } else if (stamps_ == 0 && time.source == TimeSource::stamps && time.rate_hz > 0.0) {
    found_.long_run_hz = time.rate_hz;  // each stamp is k / rate
  }
  TimingAudit out = found_;
  out.source = time.source;
  out.channel = time.channel;
  out.rate_hz = time.rate_hz;
  if (stamps_ > 1 && rate_hz_ > 0.0) take_rate(out);
  out.mended = time.mended;
  out.backwards += time.mended_backwards;
  if (stamps_ == 0 || !(rate_hz_ > 0.0)) {
    if (time.source == TimeSource::stamps) out.jitter_s = 0.0;
  } else if (regular_ > 0) {
    const double jitter_s = std::sqrt(squares_ / static_cast<double>(regular_));
    // Below this it is floating-point rounding, not jitter of a clock.
    out.jitter_s = jitter_s * rate_hz_ < 1e-9 ? 0.0 : jitter_s;
  }
  return out;
}

}  // namespace proofmass::signal
