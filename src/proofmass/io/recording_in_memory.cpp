#include "proofmass/io/recording_in_memory.hpp"

#include <fmt/format.h>
#include <utility>

#include "proofmass/io/reading/channel_units.hpp"
#include "proofmass/io/reading/finish_recording.hpp"
#include "proofmass/io/time_base.hpp"
#include "proofmass/signal/resample.hpp"

namespace proofmass::io {
namespace {

Status check_in_memory(const ReadOptions& options) {
  if (!options.time_channel.empty() || !options.variables.empty())
    return Error{Errc::invalid_argument,
                 "is in memory: a time column or a variable is chosen where it is read or made"};
  return check_rate(options);
}

Status check_lengths(const std::vector<Channel>& channels, const ArrayTimes& times) {
  if (channels.empty() || channels.front().values.empty())
    return Error{Errc::too_few_samples, "holds no sample"};
  const std::size_t samples = channels.front().values.size();
  for (const Channel& channel : channels)
    if (channel.values.size() != samples)
      return Error{Errc::invalid_argument,
                   fmt::format("{} has {} samples, {} has {}: expected as many", channel.name,
                               channel.values.size(), channels.front().name, samples)};
  if (!times.stamps_s.empty() && times.stamps_s.size() != samples)
    return Error{Errc::invalid_argument,
                 fmt::format("{} times for {} samples: expected one for each",
                             times.stamps_s.size(), samples)};
  return Done{};
}

}  // namespace

Result<Recording> recording_of_arrays(std::vector<Channel> channels,
                                      ArrayTimes times,
                                      const ReadOptions& options) {
  if (const Status rate = check_rate(options); !rate) return rate.error();
  if (const Status lengths = check_lengths(channels, times); !lengths) return lengths.error();
  Recording recording;
  recording.format = "arrays";
  recording.channels = std::move(channels);
  TimeEvidence evidence;
  evidence.samples = recording.samples();
  if (!times.stamps_s.empty()) {
    StampColumn& stamps = evidence.stamps.emplace();
    stamps.name = times.column;
    stamps.unit = *parse_unit("s");
    stamps.values = std::move(times.stamps_s);
  }
  TimeBaseFound found = find_time_base(std::move(evidence), options);
  if (found.rejected)
    return Error{Errc::invalid_argument, "the times do not rise: expected seconds, in order"};
  recording.time = std::move(found.base);
  recording.time.start_ns = times.start_ns;
  recording.notes = std::move(found.notes);
  if (const Status settled = settle_units(recording, options); !settled) return settled.error();
  return recording;
}

Result<Recording> recording_in_memory(Recording recording, const ReadOptions& options) {
  if (const Status valid = check_in_memory(options); !valid) return valid.error();
  if (options.rate_hz) {
    TimeBase by_rate;
    by_rate.source = TimeSource::given_rate;
    by_rate.rate_hz = *options.rate_hz;
    by_rate.start_ns = recording.time.start_ns;
    recording.time = std::move(by_rate);
  }
  if (options.unit) {
    if (const Status settled = settle_units(recording, options); !settled) return settled.error();
  }
  auto chosen = apply_channel_options(std::move(recording), options);
  if (!chosen || !options.resample) return chosen;
  return signal::resample(*chosen, *options.resample);
}

}  // namespace proofmass::io
