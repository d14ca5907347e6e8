#include "proofmass/signal/running_overview.hpp"

#include <algorithm>
#include <limits>

#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t most_spans = 4096;
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

RunningOverview::RunningOverview(std::size_t channels)
    : closed_(channels), open_(channels, {infinity, -infinity}) {}

void RunningOverview::add(const Block& block) {
  for (std::size_t row = 0; row < block.rows();) {
    if (filled_ == 0 && !block.stamps_s.empty()) stamps_s_.push_back(block.stamps_s[row]);
    const std::size_t count = std::min(span_ - filled_, block.rows() - row);
    for (std::size_t c = 0; c < open_.size(); ++c) {
      Range range = open_[c];
      for (const double x : block.channels[c].subspan(row, count)) {
        if (!is_plausible(x)) continue;
        range.low = std::min(range.low, x);
        range.high = std::max(range.high, x);
      }
      open_[c] = range;
    }
    row += count;
    filled_ += count;
    if (filled_ == span_) close_span();
  }
}

void RunningOverview::close_span() {
  for (std::size_t c = 0; c < open_.size(); ++c) {
    closed_[c].push_back(open_[c]);
    open_[c] = {infinity, -infinity};
  }
  filled_ = 0;
  if (++spans_ == most_spans) halve();
}

void RunningOverview::halve() {
  spans_ /= 2;
  span_ *= 2;
  for (std::vector<Range>& ranges : closed_) {
    for (std::size_t k = 0; k < spans_; ++k)
      ranges[k] = {std::min(ranges[2 * k].low, ranges[2 * k + 1].low),
                   std::max(ranges[2 * k].high, ranges[2 * k + 1].high)};
    ranges.resize(spans_);
  }
  if (stamps_s_.empty()) return;
  for (std::size_t k = 0; k < spans_; ++k) stamps_s_[k] = stamps_s_[2 * k];
  stamps_s_.resize(spans_);
}

Recording RunningOverview::finish(const Recording& head) const {
  Recording out = head;
  const std::size_t spans = spans_ + (filled_ > 0 ? 1 : 0);
  for (std::size_t k = 0; k < spans; ++k) {
    const double time_s = stamps_s_.empty() ? head.time.at(k * span_) : stamps_s_[k];
    out.time.stamps_s.insert(out.time.stamps_s.end(), 2, time_s);
  }
  for (std::size_t c = 0; c < open_.size(); ++c) {
    std::vector<double>& values = out.channels[c].values.edit();
    for (std::size_t k = 0; k < spans; ++k) {
      const Range range = k < spans_ ? closed_[c][k] : open_[c];
      const bool is_empty = range.low > range.high;
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      values.push_back(is_empty ? none : range.low);
      values.push_back(is_empty ? none : range.high);
    }
  }
  return out;
}

}  // namespace proofmass::signal
