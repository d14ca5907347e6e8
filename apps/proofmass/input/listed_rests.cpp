#include "input/listed_rests.hpp"

#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "proofmass/io/positions/interval_list.hpp"

namespace proofmass::app {
namespace {

std::size_t sample_at(const Recording& recording, double time_s) {
  std::size_t low = 0, high = recording.samples();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (recording.time.at(middle) < time_s)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

void set_samples(const Recording& recording,
                 const io::Interval& interval,
                 const std::string& list,
                 calibrate::Dwell& rest) {
  if (interval.in_samples) {
    rest.first = static_cast<std::size_t>(interval.start);
    rest.last = static_cast<std::size_t>(interval.end);
    return;
  }
  rest.first = sample_at(recording, interval.start);
  const std::size_t end = sample_at(recording, interval.end);
  if (end <= rest.first) {
    throw Failure(bad_input,
                  fmt::format("{}: line {}: {} has no sample between {} and {} s", list,
                              interval.line, recording.source, interval.start, interval.end));
  }
  rest.last = end - 1;
}

}  // namespace

std::vector<ListedRest> listed_rests(const Recording& recording, const std::string& list) {
  const auto intervals = need(io::read_intervals(list), Stage::reading);
  const Status inside = io::check_inside(intervals, recording.duration_s(), recording.samples());
  if (!inside) throw Failure(bad_input, inside.error().at(list));
  std::vector<ListedRest> rests;
  for (const io::Interval& interval : intervals) {
    ListedRest& rest = rests.emplace_back();
    rest.dwell.label = interval.label;
    if (interval.up) rest.dwell.up = Eigen::Vector3d(interval.up->data());
    rest.angle_rad = interval.angle_rad;
    set_samples(recording, interval, list, rest.dwell);
  }
  return rests;
}

}  // namespace proofmass::app
