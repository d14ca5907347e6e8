#include "proofmass/acquire/recorder/level_gate.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::acquire {

Block part_of(const Block& block, std::size_t first, std::size_t count) {
  Block part;
  part.first = block.first + first;
  for (const View<double> channel : block.channels)
    part.channels.push_back(channel.subspan(first, count));
  part.stamps_s = block.stamps_s.subspan(first, count);
  return part;
}

RecentRows::RecentRows(std::size_t columns, std::size_t most_rows) : most_rows_(most_rows) {
  rows_.channels.resize(columns);
}

void RecentRows::add(const Block& block) {
  rows_.stamps_s.insert(rows_.stamps_s.end(), block.stamps_s.begin(), block.stamps_s.end());
  for (std::size_t c = 0; c < rows_.channels.size(); ++c)
    rows_.channels[c].insert(rows_.channels[c].end(), block.channels[c].begin(),
                             block.channels[c].end());
}

std::size_t RecentRows::drop_before(double time_s) {
  const auto begin = rows_.stamps_s.begin() + static_cast<std::ptrdiff_t>(first_);
  const auto kept = std::lower_bound(begin, rows_.stamps_s.end(), time_s);
  const auto early = static_cast<std::size_t>(kept - begin);
  return drop_first(std::max(early, rows() > most_rows_ ? rows() - most_rows_ : 0));
}

std::size_t RecentRows::drop_first(std::size_t count) {
  first_ += count;
  if (first_ * 2 < rows_.rows()) return count;
  const auto gone = static_cast<std::ptrdiff_t>(first_);
  rows_.stamps_s.erase(rows_.stamps_s.begin(), rows_.stamps_s.begin() + gone);
  for (std::vector<double>& channel : rows_.channels)
    channel.erase(channel.begin(), channel.begin() + gone);
  first_ = 0;
  return count;
}

Block RecentRows::view() const {
  return part_of(view_of(rows_, 0), first_, rows());
}

LevelGate::LevelGate(const LevelTrigger& trigger,
                     std::size_t channel,
                     std::size_t channels,
                     std::size_t estimate_columns,
                     std::size_t most_bytes)
    : trigger_(trigger),
      channel_(channel),
      recent_(channels, most_bytes / (8 * (channels + 1))),
      recent_estimates_(estimate_columns, most_bytes / (8 * (estimate_columns + 1))) {}

bool LevelGate::passes(double value) {
  if (!std::isfinite(value)) return false;
  const bool is_rising = trigger_.edge == LevelTrigger::Edge::rising;
  const bool was_short = is_rising ? before_ < trigger_.level : before_ > trigger_.level;
  const bool is_there = is_rising ? value >= trigger_.level : value <= trigger_.level;
  before_ = value;
  return was_short && is_there;
}

/// Keeps the rows that waited for the decision.
void LevelGate::open(double time_s, const Keep& keep) {
  const double from_s = time_s - trigger_.before_s;
  const bool is_apart = from_s > until_s_;
  until_s_ = time_s + trigger_.after_s;
  if (is_apart) {
    windows_.push_back({from_s, until_s_});
    dropped_ += recent_.drop_before(from_s);
    keep.begin_stretch(recent_.rows() > 0 ? recent_.time_s(0) : time_s);
  } else {
    windows_.back().until_s = until_s_;
  }
  keep.triggered(time_s);
  if (recent_.rows() > 0) keep.samples(recent_.view());
  recent_.drop_first(recent_.rows());
}

void LevelGate::add_samples(const Block& block, const Keep& keep) {
  std::size_t done = 0;
  const auto hand_on = [&](std::size_t end) {
    if (end == done) return;
    const Block part = part_of(block, done, end - done);
    if (part.stamps_s.back() <= until_s_)
      keep.samples(part);
    else
      recent_.add(part);
    done = end;
  };
  for (std::size_t i = 0; i < block.rows(); ++i) {
    const double time_s = block.stamps_s[i];
    const bool was_kept = i > 0 && block.stamps_s[i - 1] <= until_s_;
    if (was_kept && time_s > until_s_) hand_on(i);
    if (!passes(block.channels[channel_][i])) continue;
    hand_on(i);
    open(time_s, keep);
  }
  hand_on(block.rows());
  now_s_ = block.rows() > 0 ? block.stamps_s.back() : now_s_;
  dropped_ += recent_.drop_before(now_s_ - trigger_.before_s);
}

void LevelGate::add_estimates(const Block& rows, const Keep& keep) {
  recent_estimates_.add(rows);
  let_estimates(keep);
}

void LevelGate::let_estimates(const Keep& keep) {
  while (recent_estimates_.rows() > 0) {
    const double first_s = recent_estimates_.time_s(0);
    while (!windows_.empty() && windows_.front().until_s < first_s &&
           (windows_.size() > 1 || until_s_ < now_s_ - trigger_.before_s))
      windows_.pop_front();
    const double from_s = windows_.empty() ? now_s_ - trigger_.before_s : windows_.front().from_s;
    if (recent_estimates_.drop_before(from_s) > 0) continue;
    if (windows_.empty() || first_s > windows_.front().until_s) return;
    const Block waiting = recent_estimates_.view();
    const auto end = std::ranges::upper_bound(waiting.stamps_s, windows_.front().until_s);
    const auto count = static_cast<std::size_t>(end - waiting.stamps_s.begin());
    keep.estimates(part_of(waiting, 0, count));
    recent_estimates_.drop_first(count);
  }
}

}  // namespace proofmass::acquire
