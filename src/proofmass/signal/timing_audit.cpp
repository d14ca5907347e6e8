#include "proofmass/signal/timing_audit.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/signal/chunk_figures.hpp"

namespace proofmass::signal {

void RunningTiming::add(View<double> stamps_s) {
  if (stamps_s.empty()) return;
  if (rate_hz_ > 0.0) {
    if (stamps_ > 0) add_step(last_s_, stamps_s[0] - last_s_);
    const StepFigures steps = step_figures(stamps_s, 1.0 / rate_hz_);
    if (steps.regular) {
      squares_ += steps.squares;
      regular_ += stamps_s.size() - 1;
    } else {
      for (std::size_t k = 1; k < stamps_s.size(); ++k)
        add_step(stamps_s[k - 1], stamps_s[k] - stamps_s[k - 1]);
    }
  }
  stamps_ += stamps_s.size();
  last_s_ = stamps_s.back();
  if (rate_hz_ > 0.0) {
    if (band_s_ > 0.0) recent_.insert(recent_.end(), stamps_s.begin(), stamps_s.end());
    holes_.add(stamps_s, fresh_);
    take_holes();
  }
}

// The holes found by now, as gaps; and forgets the stamps that none can be found among any more.
void RunningTiming::take_holes() {
  const std::size_t first = stamps_ - recent_.size();
  if (band_s_ > 0.0)
    for (const Hole& hole : fresh_)
      add_gap({recent_[hole.before - 1 - first], static_cast<double>(hole.missing + 1) / rate_hz_});
  fresh_.clear();
  const std::size_t kept = std::min(recent_.size(), HoleFinder::most_undecided + 1);
  recent_.erase(recent_.begin(), recent_.end() - static_cast<std::ptrdiff_t>(kept));
}

void RunningTiming::add_gap(const Gap& gap) {
  ++found_.gap_count;
  if (found_.gaps.size() < most_listed) found_.gaps.push_back(gap);
  if (gap.duration_s > found_.longest_gap.duration_s) found_.longest_gap = gap;
}

void RunningTiming::add_step(double before_s, double step_s) {
  const double nominal_s = 1.0 / rate_hz_;
  const double deviation_s = step_s - nominal_s;
  if (step_s < 0.0) ++found_.backwards;
  if (step_s == 0.0) ++found_.repeated;
  if (step_s > 1.5 * nominal_s && band_s_ == 0.0) add_gap({before_s, step_s});
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
  out.mended = time.mended;
  out.backwards += time.mended_backwards;
  if (stamps_ == 0 || !(rate_hz_ > 0.0)) {
    if (time.source == TimeSource::stamps) out.jitter_s = 0.0;
  } else if (regular_ > 0) {
    const double jitter_s = std::sqrt(squares_ / static_cast<double>(regular_));
    // Below this it is the rounding of doubles, not of a clock.
    out.jitter_s = jitter_s * rate_hz_ < 1e-9 ? 0.0 : jitter_s;
  }
  return out;
}

}  // namespace proofmass::signal
