#include "proofmass/signal/resample/hole_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t nearby = 8;     // samples on either side of a long interval
constexpr double longest_step = 1.5;  // in sample periods, if no sample is missing

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
    if (!(steps > longest_step)) {
      ascending_ = ascending_ && steps > -1.0;
      squares_ += (steps - 1.0) * (steps - 1.0);
      ++regular_;
      continue;
    }
    if (!is_end && at + nearby >= recent_.size()) return;
    count(missing_before(at), holes);
  }
}

// Samples missing before the one at this index of the recent ones, which follows a long interval.
//
// - By the interval, if it is a whole number of periods to within a fourth; otherwise by the
//   medians of up to `nearby` stamps on either side, relative to an even grid, as far as no other
//   long interval follows: these average out the jitter of the two stamps.
// - At most as many as are missing in all of `nearby` stamps on either side, other long intervals
//   included: after late stamps others follow early.
double HoleFinder::missing_before(std::size_t at) const {
  constexpr double clear = 0.25;
  const auto offset = [&](std::size_t k) {
    return (recent_[k] - recent_[at]) * rate_hz_ -
           (static_cast<double>(k) - static_cast<double>(at));
  };
  const auto is_long = [&](std::size_t k) {
    return (recent_[k] - recent_[k - 1]) * rate_hz_ > longest_step;
  };
  std::array<double, nearby> offsets{};
  const auto median_of = [&](std::size_t from, std::size_t end) {
    for (std::size_t k = from; k < end; ++k) offsets[k - from] = offset(k);
    return *median(View<double>(offsets).first(end - from));
  };
  double missing = -offset(at - 1);
  if (std::abs(missing - std::round(missing)) > clear) {
    std::size_t first = at - 1, end = at + 1;
    while (first > 0 && at - first < nearby && !is_long(first)) --first;
    while (end < recent_.size() && end - at < nearby && !is_long(end)) ++end;
    missing = median_of(at, end) - median_of(first, at);
  }
  const double in_all =
      offset(std::min(at + nearby, recent_.size() - 1)) - offset(at - std::min(at, nearby));
  // Rounded up: the jitter of the outermost stamps must not hide a missing sample.
  return std::max(0.0, std::min(std::round(missing), std::floor(in_all + 1.0 - clear)));
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
