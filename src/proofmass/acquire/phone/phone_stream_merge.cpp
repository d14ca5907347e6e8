#include "proofmass/acquire/phone/phone_stream_merge.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "proofmass/core/contract.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::int64_t longest_wait_ns = 1'000'000'000;
/// A clock that decreases by more was set back; by less, samples are out of order.
constexpr std::int64_t set_back_ns = 1'000'000'000;
/// Maximum number of waiting samples per sensor, if clocks stop or jump.
constexpr std::size_t most_waiting = 100'000;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

PhoneStreamMerge::PhoneStreamMerge(const std::vector<std::size_t>& widths) {
  PM_EXPECTS(!widths.empty());
  for (const std::size_t width : widths) tracks_.push_back({.width = width});
  has_begun_ = widths.size() == 1;
}

void PhoneStreamMerge::Track::drop_first() {
  instants.pop_front();
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
}

void PhoneStreamMerge::add(std::size_t sensor,
                           std::int64_t device_ns,
                           std::span<const double> values) {
  Track& track = tracks_[sensor];
  PM_EXPECTS(values.size() == track.width && std::abs(device_ns) <= largest_ns);
  const Instant now{.era = era_of(track, device_ns), .ns = device_ns};
  track.newest = now;
  track.instants.push_back(now);
  track.values.insert(track.values.end(), values.begin(), values.end());
  if (sensor != 0 && track.instants.size() > most_waiting) track.drop_first();
}

std::uint64_t PhoneStreamMerge::era_of(const Track& track, std::int64_t ns) const {
  std::uint64_t era = track.newest.era + (track.newest.ns - ns > set_back_ns ? 1 : 0);
  // A single wrong clock value of one sensor must not separate it from the others permanently.
  for (const Track& other : tracks_)
    if (std::abs(ns - other.newest.ns) <= set_back_ns) era = std::max(era, other.newest.era);
  return era;
}

void PhoneStreamMerge::take(Arrival& out) {
  Track& leader = tracks_.front();
  while (!leader.instants.empty()) {
    const Instant row = leader.instants.front();
    for (std::size_t k = 1; k < tracks_.size(); ++k)
      while (tracks_[k].instants.size() > 1 && tracks_[k].instants[1] <= row)
        tracks_[k].drop_first();
    if (!is_settled(row) && !is_too_late(row)) return;
    has_begun_ = has_begun_ || have_all_begun(row) || is_too_late(row);
    if (has_begun_)
      put_row(row, out);
    else
      ++skipped_;
    leader.drop_first();
  }
}

bool PhoneStreamMerge::is_settled(const Instant& row) const {
  return std::all_of(tracks_.begin() + 1, tracks_.end(), [&](const Track& track) {
    return !track.instants.empty() && track.newest >= row;
  });
}

bool PhoneStreamMerge::is_too_late(const Instant& row) const {
  const Track& leader = tracks_.front();
  return leader.newest.era != row.era || leader.newest.ns - row.ns > longest_wait_ns ||
         leader.instants.size() > most_waiting;
}

bool PhoneStreamMerge::have_all_begun(const Instant& row) const {
  return std::all_of(tracks_.begin() + 1, tracks_.end(), [&](const Track& track) {
    return !track.instants.empty() && track.instants.front() <= row;
  });
}

void PhoneStreamMerge::put_row(const Instant& row, Arrival& out) {
  std::size_t column = 0;
  bool is_whole = true;
  for (const Track& track : tracks_) {
    is_whole = put_values(track, row, out, column) && is_whole;
    column += track.width;
  }
  out.device_ns.push_back(row.ns);
  if (!is_whole) ++incomplete_;
}

std::vector<Note> PhoneStreamMerge::take_notes() {
  std::vector<Note> notes;
  if (has_begun_ && skipped_ > 0)
    notes.push_back(
        {Severity::info, fmt::format("skipped {} samples from before all sensors had begun",
                                     std::exchange(skipped_, 0))});
  if (incomplete_ < noted_at_) return notes;
  notes.push_back(
      {Severity::warning,
       fmt::format("{} rows so far lack a sensor's values, which are NaN there", incomplete_)});
  while (noted_at_ <= incomplete_) noted_at_ *= 10;
  return notes;
}

bool PhoneStreamMerge::put_values(const Track& track,
                                  const Instant& row,
                                  Arrival& out,
                                  std::size_t column) {
  const auto& at = track.instants;
  const bool is_there = !at.empty() && at.front() == row;
  const bool is_between = !is_there && at.size() > 1 && at[0] < row && row < at[1] &&
                          at[0].era == at[1].era && at[1].ns - at[0].ns <= longest_wait_ns;
  const double share =
      is_between ? static_cast<double>(row.ns - at[0].ns) / static_cast<double>(at[1].ns - at[0].ns)
                 : 0.0;
  for (std::size_t k = 0; k < track.width; ++k) {
    double value = nan;
    if (is_there) value = track.values[k];
    if (is_between)
      value = track.values[k] + share * (track.values[track.width + k] - track.values[k]);
    out.channels[column + k].push_back(value);
  }
  return is_there || is_between;
}

}  // namespace proofmass::acquire
