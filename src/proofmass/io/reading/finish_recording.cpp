#include "proofmass/io/reading/finish_recording.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <set>

#include "proofmass/io/names.hpp"
#include "proofmass/io/reading/channel_units.hpp"
#include "proofmass/io/reading/raw_rows.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/time/clock_pair.hpp"
#include "proofmass/signal/resample/counter.hpp"
#include "proofmass/signal/skew.hpp"

namespace proofmass::io {
namespace {

void attach_time(Recording& recording,
                 const RawHead& head,
                 std::vector<double> stamps,
                 const ReadOptions& options) {
  TimeEvidence evidence;
  evidence.samples = head.stamps ? stamps.size() : recording.samples();
  evidence.stamps = head.stamps;
  if (evidence.stamps) evidence.stamps->values = std::move(stamps);
  evidence.header_rate_hz = head.rate_hz;
  evidence.first_line = recording.first_line;
  if (const auto counter = signal::find_counter(recording)) {
    evidence.counter_name = recording.channels[*counter].name;
    evidence.counter = recording.channels[*counter].values;
  }
  TimeBaseFound found = find_time_base(std::move(evidence), options);
  recording.time = std::move(found.base);
  const bool is_by_rate = recording.time.source == TimeSource::given_rate;
  if (is_by_rate && !recording.time.start_ns) recording.time.start_ns = head.start_ns;
  std::ranges::move(found.notes, std::back_inserter(recording.notes));
  if (!found.rejected) return;
  // A rejected time column is an ordinary channel.
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

/// The channels of a matrix's columns, or of a sensor's axes: "acc" is "acc_x", "acc_y" and
/// "acc_z".
std::vector<std::size_t> columns_of(const Recording& recording, const std::string& name) {
  std::vector<std::size_t> columns;
  const std::string stem = lower(name);
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    const std::string channel = lower(recording.channels[c].name);
    if (!stem.empty() && channel.starts_with(stem) &&
        (channel[stem.size()] == '_' || channel[stem.size()] == ' '))
      columns.push_back(c);
  }
  return columns;
}

}  // namespace

Status check_rate(const ReadOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0.0 && *options.rate_hz < 1e12))
    return Error{Errc::invalid_argument, "the rate must be above zero"};
  return Done{};
}

Result<std::vector<std::size_t>> chosen_channels(const Recording& recording,
                                                 const std::vector<std::string>& names) {
  std::set<std::size_t> chosen;
  for (const std::string& name : names) {
    const Channel* channel = recording.find(name);
    if (channel != nullptr) {
      chosen.insert(static_cast<std::size_t>(channel - recording.channels.data()));
      continue;
    }
    const std::vector<std::size_t> columns = columns_of(recording, name);
    if (columns.empty())
      return Error{Errc::invalid_argument,
                   fmt::format("has no channel {}; it has {}", name, names_of(recording))};
    chosen.insert(columns.begin(), columns.end());
  }
  if (names.empty())
    for (std::size_t c = 0; c < recording.channels.size(); ++c) chosen.insert(c);
  return std::vector<std::size_t>(chosen.begin(), chosen.end());
}

Result<Recording> finish_recording(RecordingReader& reader,
                                   RawRows rows,
                                   const ReadOptions& options) {
  if (const Status rate = check_rate(options); !rate) return rate.error();
  if (rows_of(rows) == 0) return Error{Errc::too_few_samples, "holds no sample"};
  Recording recording = reader.head().recording;
  for (std::size_t c = 0; c < recording.channels.size(); ++c)
    recording.channels[c].values = std::move(rows.channels[c]);
  reader.finish(recording);
  attach_time(recording, reader.head(), std::move(rows.stamps), options);
  if (recording.channels.empty())
    return Error{Errc::too_few_samples, "has no column of numbers beside the time"};
  clean_texts(recording);
  if (const Status settled = settle_units(recording, options); !settled) return settled.error();
  note_other_clocks(recording);
  return apply_channel_options(std::move(recording), options);
}

Result<Recording> apply_channel_options(Recording recording, const ReadOptions& options) {
  if (options.skew_s != 0.0) {
    auto even = signal::without_skew(recording, options.skew_s);
    if (!even) return even.error();
    recording = std::move(even).value();
  }
  const auto chosen = chosen_channels(recording, options.channels);
  if (!chosen) return chosen.error();
  std::vector<Channel> kept;
  for (const std::size_t c : *chosen) kept.push_back(std::move(recording.channels[c]));
  recording.channels = std::move(kept);
  return recording;
}

Result<Recording> read_whole(RecordingReader& reader, const ReadOptions& options) {
  if (const Status rate = check_rate(options); !rate) return rate.error();
  RawRows rows;
  if (const Status read = reader.next(std::numeric_limits<std::size_t>::max(), rows); !read)
    return read.error();
  return finish_recording(reader, std::move(rows), options);
}

}  // namespace proofmass::io
