#include "proofmass/io/finish_recording.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <set>

#include "proofmass/io/channel_units.hpp"
#include "proofmass/signal/counter.hpp"

namespace proofmass::io {
namespace {

void attach_time(Recording& recording,
                 std::optional<StampColumn> stamps,
                 std::optional<double> header_rate_hz,
                 const ReadOptions& options) {
  TimeEvidence evidence;
  evidence.samples = stamps ? stamps->values.size() : recording.samples();
  evidence.stamps = std::move(stamps);
  evidence.header_rate_hz = header_rate_hz;
  evidence.first_line = recording.first_line;
  if (const auto counter = signal::find_counter(recording)) {
    evidence.counter_name = recording.channels[*counter].name;
    evidence.counter = recording.channels[*counter].values;
  }
  TimeBaseFound found = find_time_base(std::move(evidence), options);
  recording.time = std::move(found.base);
  std::ranges::move(found.notes, std::back_inserter(recording.notes));
  if (!found.rejected) return;
  // What is no time is a channel like any other.
  StampColumn& column = *found.rejected;
  for (double& value : column.values) value += column.origin.value();
  recording.channels.insert(recording.channels.begin(),
                            {column.name, column.unit, std::move(column.values)});
}

/// "ax, ay, az"
std::string names_of(const Recording& recording) {
  std::string names;
  for (const Channel& channel : recording.channels) {
    if (names.size() > 200) return names + ", …";
    names += (names.empty() ? "" : ", ") + channel.name;
  }
  return names;
}

Status keep_chosen(Recording& recording, const std::vector<std::string>& names) {
  std::set<const Channel*> chosen;
  for (const std::string& name : names) {
    const Channel* channel = recording.find(name);
    if (channel == nullptr)
      return Error{Errc::invalid_argument,
                   fmt::format("has no channel {}; it has {}", name, names_of(recording))};
    chosen.insert(channel);
  }
  std::vector<Channel> kept;
  for (Channel& channel : recording.channels)
    if (names.empty() || chosen.contains(&channel)) kept.push_back(std::move(channel));
  recording.channels = std::move(kept);
  return Done{};
}

bool is_positive(double rate_hz) {
  return rate_hz > 0.0 && rate_hz < 1e12;
}

}  // namespace

Result<Recording> finish_recording(Recording recording,
                                   std::optional<StampColumn> stamps,
                                   std::optional<double> header_rate_hz,
                                   const ReadOptions& options) {
  if (options.rate_hz && !is_positive(*options.rate_hz))
    return Error{Errc::invalid_argument, "the rate must be above zero"};
  attach_time(recording, std::move(stamps), header_rate_hz, options);
  if (recording.channels.empty())
    return Error{Errc::too_few_samples, "has no column of numbers beside the time"};
  settle_units(recording, options);
  if (const Status kept = keep_chosen(recording, options.channels); !kept) return kept.error();
  return recording;
}

}  // namespace proofmass::io
