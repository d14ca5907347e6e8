#include "proofmass/signal/rests/recent_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/rests/lengths.hpp"
#include "proofmass/signal/rests/runs.hpp"

namespace proofmass::signal {
namespace {

bool find_rate(View<double> times_s) {
  constexpr std::size_t fewest = 16, most = 4096;
  return times_s.size() >= most ||
         (times_s.size() >= fewest && times_s.back() - times_s.front() >= 2.0);
}

}  // namespace

std::size_t RecentBlocks::add(double time_s,
                              View<double> values,
                              const std::optional<RestNoise>& noise) {
  PM_EXPECTS(values.size() == axes_);
  if (!begun_ && options_.rate_hz == 0.0) {
    waiting_s_.push_back(time_s);
    waiting_.insert(waiting_.end(), values.begin(), values.end());
    if (!find_rate(waiting_s_)) return 0;
    const double elapsed_s = waiting_s_.back() - waiting_s_.front();
    if (elapsed_s > 0.0) options_.rate_hz = static_cast<double>(waiting_s_.size() - 1) / elapsed_s;
    begin();
    std::size_t full = 0;
    for (std::size_t k = 0; k < waiting_s_.size(); ++k)
      full += add_row(waiting_s_[k], View<double>(waiting_).subspan(k * axes_, axes_), noise);
    waiting_s_ = {};
    waiting_ = {};
    return full;
  }
  if (!begun_) begin();
  return add_row(time_s, values, noise);
}

void RecentBlocks::begin() {
  const RestLengths lengths = rest_lengths(options_);
  blocks_ = no_blocks(axes_, lengths.window);
  shortest_ = lengths.shortest;
  const double rate_hz = options_.rate_hz > 0.0 ? options_.rate_hz : 100.0;
  window_s_ = static_cast<double>(blocks_.window * blocks_.block) / rate_hz;
  seekers_.fill(LsbDetector(lengths.window));
  begun_ = true;
}

std::size_t RecentBlocks::add_row(double time_s,
                                  View<double> values,
                                  const std::optional<RestNoise>& noise) {
  std::size_t full = 0;
  if (samples_ > 0 && !(std::abs(time_s - last_s_) <= window_s_)) {
    for (std::vector<double>& axis : open_) axis.clear();
    for (; full <= blocks_.window; ++full) push({}, {last_s_, time_s});
  }
  last_s_ = time_s;
  if (open_[0].empty()) open_span_.start_s = time_s;
  open_span_.end_s = time_s;
  const bool there = std::ranges::all_of(values, [](double x) { return is_plausible(x); });
  for (std::size_t a = 0; a < axes_; ++a) {
    open_[a].push_back(values[a]);
    if (!there) continue;
    seekers_[a].add(samples_, values[a]);
    largest_[a] = std::max(largest_[a], std::abs(values[a]));
  }
  ++samples_;
  if (open_[0].size() < blocks_.block) return full;
  close(noise);
  return full + 1;
}

void RecentBlocks::close(const std::optional<RestNoise>& noise) {
  const std::array<View<double>, most_axes> open{open_[0], open_[1], open_[2]};
  const View<View<double>> axes = View<View<double>>(open).first(axes_);
  const RestBlocks one = blocks_of(axes, 8 * blocks_.block);
  push(one.at(0), open_span_);
  const std::size_t last = blocks_.size() - 1;
  if (noise && !blocks_.missing(last)) {
    const QuietTest test(blocks_);
    if (!test.passes(blocks_, *noise, last)) {
      blocks_.set(last, without_outlier(axes, one, 0, noise->block_variance));
      if (!test.passes(blocks_, *noise, last)) blocks_.set(last, one.at(0));
    }
  }
  for (std::vector<double>& axis : open_) axis.clear();
}

void RecentBlocks::push(const RestBlock& block, Span span) {
  if (blocks_.size() == most) {
    blocks_.drop_first();
    spans_.erase(spans_.begin());
  }
  blocks_.resize(blocks_.size() + 1);
  blocks_.set(blocks_.size() - 1, block);
  spans_.push_back(span);
  for (std::size_t a = 0; a < axes_; ++a) {
    blocks_.quantum[a] = seekers_[a].quantum();
    blocks_.variance_floor[a] = variance_floor(blocks_.quantum[a], largest_[a]);
  }
}

}  // namespace proofmass::signal
