#include "proofmass/signal/resample/hole_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t nearby = 8;       // samples on either side of a long interval
constexpr double longest_step = 1.5;    // in sample periods, usually if no sample is missing
constexpr double doubtful_step = 1.25;  // in sample periods, if one may be missing

}  // namespace

void HoleFinder::add(View<double> stamps_s, std::vector<Hole>& holes) {
  if (stamps_s.empty()) return;
  if (samples_ == 0) {
    first_s_ = stamps_s.front();
    decided_ = 1;
    if (band_) band_->take(first_s_, 0.0);
  }
  last_s_ = stamps_s.back();
  recent_.insert(recent_.end(), stamps_s.begin(), stamps_s.end());
  samples_ += stamps_s.size();
  if (band_)
    decide_by_band(false, holes);
  else
    decide(false, holes);
  // Keeps the stamps with which the next undecided sample may be compared.
  const std::size_t needed = std::min(recent_.size(), samples_ - decided_ + nearby);
  recent_.erase(recent_.begin(), recent_.end() - static_cast<std::ptrdiff_t>(needed));
}

void HoleFinder::finish(std::vector<Hole>& holes) {
  if (band_)
    decide_by_band(true, holes);
  else
    decide(true, holes);
}

void HoleFinder::count(double missing, std::vector<Hole>& holes) {
  missing_ += missing;
  if (!(missing >= 1.0)) return;
  ++hole_count_;
  // Limited: beyond any recording's size, which check() rejects.
  holes.push_back({decided_, static_cast<std::size_t>(std::min(missing, 0x1p62))});
  std::erase_if(near_, [&](const Hole& hole) { return hole.before + nearby < decided_; });
  near_.push_back(holes.back());
}

void HoleFinder::decide_by_band(bool is_end, std::vector<Hole>& holes) {
  const std::size_t first = samples_ - recent_.size();
  for (; decided_ < samples_; ++decided_) {
    const std::size_t at = decided_ - first;
    double missing = 0.0;
    if (!band_->holds(recent_[at])) {
      if (!is_end && at + StampBand::ahead > recent_.size()) return;
      const std::size_t after = std::min(StampBand::ahead, recent_.size() - at);
      missing = band_->missing_before(View<double>(recent_).subspan(at, after));
    }
    band_->take(recent_[at], missing);
    const double steps = (recent_[at] - recent_[at - 1]) * rate_hz_;
    ascending_ = ascending_ && steps > -1.0;
    if (missing == 0.0) {
      squares_ += (steps - 1.0) * (steps - 1.0);
      ++regular_;
    }
    count(missing, holes);
  }
}

void HoleFinder::decide(bool is_end, std::vector<Hole>& holes) {
  const std::size_t first = samples_ - recent_.size();
  for (; decided_ < samples_; ++decided_) {
    const std::size_t at = decided_ - first;
    const double steps = (recent_[at] - recent_[at - 1]) * rate_hz_;
    const bool is_doubtful = steps > longest_step || may_be_two(steps);
    if (is_doubtful && !is_end && at + needed_after(at) >= recent_.size()) return;
    if (!(steps > longest_step)) {
      ascending_ = ascending_ && steps > -1.0;
      squares_ += (steps - 1.0) * (steps - 1.0);
      ++regular_;
    }
    if (is_doubtful) count(missing_before(at), holes);
  }
}

// Whether jitter may have shortened an interval of two periods to this one.
bool HoleFinder::may_be_two(double steps) const {
  constexpr double jitters = 4.0;
  constexpr std::size_t fewest = 100;
  if (!(steps > doubtful_step) || regular_ < fewest) return false;
  return square(2.0 - steps) * static_cast<double>(regular_) < square(jitters) * squares_;
}

bool HoleFinder::is_long(std::size_t at) const {
  return (recent_[at] - recent_[at - 1]) * rate_hz_ > longest_step;
}

// Later rows with which the long interval before this one is judged: after a stall of the computer,
// as many as were late.
std::size_t HoleFinder::needed_after(std::size_t at) const {
  const double late = (recent_[at] - recent_[at - 1]) * rate_hz_;
  constexpr double longest_stall = most_undecided - nearby - 1;
  const bool may_be_stall = late > nearby + 1 && late < longest_stall;
  return may_be_stall ? nearby + static_cast<std::size_t>(late) : nearby;
}

// In periods, relative to an even grid through another sample. Samples missing before it count only
// where they are decided.
double HoleFinder::lateness(std::size_t at, std::size_t than) const {
  return (recent_[at] - recent_[than]) * rate_hz_ - (number_of(at) - number_of(than));
}

// On the grid, relative to that of the first undecided sample if none is missing before it.
double HoleFinder::number_of(std::size_t at) const {
  const std::size_t sample = at + samples_ - recent_.size();
  double number = static_cast<double>(sample) - static_cast<double>(decided_);
  for (const Hole& hole : near_)
    if (hole.before > sample) number -= static_cast<double>(hole.missing);
  return number;
}

double HoleFinder::median_lateness(std::size_t from, std::size_t end, std::size_t than) const {
  std::array<double, nearby> all{};
  for (std::size_t k = from; k < end; ++k) all[k - from] = lateness(k, than);
  return *median(View<double>(all).first(end - from));
}

// Samples missing before the one at this index of the recent ones, the first undecided one, which
// follows a long interval.
//
// - By the interval, if it is a whole number of periods to within a fourth; otherwise by the
//   medians of up to `nearby` stamps on either side, relative to an even grid, up to the next long
//   interval: these average out the jitter of the two stamps.
// - Then at most as many as by the median of all `nearby` later stamps, which are later still where
//   more are missing.
// - At most as many as are missing in all of `nearby` stamps on either side: after late stamps
//   others follow early.
double HoleFinder::missing_before(std::size_t at) {
  constexpr double clear = 0.25;
  const std::size_t last = std::min(at + nearby, recent_.size());
  std::size_t end = at + 1;
  while (end < last && !is_long(end)) ++end;
  const double before = median_lateness(at - std::min(at, nearby), at, at);
  const double shift = median_lateness(at, end, at) - before;
  const double of_most = median_lateness(at, last, at) - before;
  if (!is_long(at)) {
    const double missing = std::min(shift, of_most) > 1.0 - clear ? 1.0 : 0.0;
    add_doubt(shift - missing);
    return missing;
  }
  const double interval = -lateness(at - 1, at);
  const bool is_clear = std::abs(interval - std::round(interval)) <= clear;
  double missing = std::round(is_clear ? interval : std::min(shift, of_most));
  const double in_all = lateness(std::min(at + nearby, recent_.size() - 1), at) -
                        lateness(at - std::min(at, nearby), at);
  // Rounded up: the jitter of the outermost stamps must not hide a missing sample.
  missing = std::max(0.0, std::min(missing, std::floor(in_all + 1.0 - clear)));
  if (!is_clear) add_doubt(shift - missing);
  return missing > nearby ? missing_after_stall(at, missing) : missing;
}

// A median that is less than a fourth of a period off confirms the number.
void HoleFinder::add_doubt(double off) {
  constexpr double clear = 0.25;
  if (std::abs(off) > clear) doubt_ += std::min(1.0, square(off));
}

// If the computer stalled, all rows of that time were stamped when it went on: the stamps that
// follow are early. At most as many samples are missing as are still missing once as many rows have
// followed, by the medians of up to `nearby` stamps, unless others are missing among these rows.
double HoleFinder::missing_after_stall(std::size_t at, double missing) const {
  const std::size_t last = std::min(at + needed_after(at), recent_.size()) - 1;
  std::size_t from = at;
  while (from + nearby < last + 1 && !is_long(from + 1)) ++from;
  std::size_t end = from + 1;
  while (end <= last && end - from < nearby && !is_long(end)) ++end;
  const double remaining =
      median_lateness(from, end, at) - median_lateness(at - std::min(at, nearby), at, at);
  return std::clamp(std::round(remaining), 0.0, missing);
}

Status HoleFinder::check(std::size_t samples, double spare) const {
  if (missing_ <= 3.0 * static_cast<double>(samples) + spare) return Done{};
  return Error{Errc::corrupt,
               fmt::format("the gaps in the stamps are as long as {:.3g} samples, and there "
                           "are {}: analyse a part, or ignore the stamps and state the rate",
                           missing_, samples),
               {Advice{"from"}, Advice{"to"}, Advice{"rate"}}};
}

EvenGrid HoleFinder::grid() const {
  EvenGrid grid{.rate_hz = rate_hz_, .recorded = samples_, .missing = 0, .holes = {}};
  grid.missing = static_cast<std::size_t>(std::min(missing_, 0x1p62));
  if (regular_ > 0) grid.relative_jitter = std::sqrt(squares_ / static_cast<double>(regular_));
  const double duration_s = last_s_ - first_s_;
  const double mean_hz = static_cast<double>(samples_ + grid.missing - 1) / duration_s;
  if (ascending_ && std::abs(mean_hz / rate_hz_ - 1.0) < 0.02) grid.rate_hz = mean_hz;
  return grid;
}

}  // namespace proofmass::signal
