#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms_map.hpp"
#include "proofmass/io/tdms_scaling.hpp"

namespace proofmass::io {

/// Channels of one group that were sampled together.
struct TdmsGroup {
  std::string name;  ///< the group's, with what tells it from others of the group behind
  std::vector<std::uint32_t> channels;  ///< objects of the map
  std::vector<std::string> headings;    ///< unit included
  std::uint64_t rows = 0;               ///< of the longest channel
  std::optional<double> rate_hz;
  std::optional<std::int64_t> start_ns;    ///< of row 0, since 1970
  std::optional<std::size_t> time_column;  ///< points in time, or seconds since start_ns
  std::vector<Note> notes;
};

/// What turns the stored values of a channel into those measured: said of itself, of its group or
/// of the file. Errors: as TdmsScaling::of().
[[nodiscard]] Result<std::optional<TdmsScaling>> scaling_of(const TdmsMap& map,
                                                            std::uint32_t channel);

/// The scalers of a channel of DAQmx raw data, in the order of the file; empty for any other.
[[nodiscard]] std::vector<std::uint32_t> scalers_of(const TdmsMap& map, std::uint32_t channel);

/// Sorts the channels that hold figures into tables: those of one group, length, rate and start.
/// Groups are never joined, even where they would fit: each is a measurement of its own to
/// LabVIEW's users. A channel that lacks values only because the file breaks off stays with the
/// others.
[[nodiscard]] std::vector<TdmsGroup> group_channels(const TdmsMap& map);

/// What channels hold that are not read, one note for the file; empty if there are none.
[[nodiscard]] std::vector<Note> notes_on_unread(const TdmsMap& map);

}  // namespace proofmass::io
