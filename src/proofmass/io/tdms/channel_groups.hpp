#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/map.hpp"
#include "proofmass/io/tdms/scaling.hpp"

namespace proofmass::io::tdms {

/// Channels of one group that were sampled together.
struct Group {
  std::string name;                     ///< the group's, with a suffix if the group has several
  std::vector<std::uint32_t> channels;  ///< indices into the map's objects
  std::vector<std::string> headings;    ///< with units
  std::uint64_t rows = 0;               ///< length of the longest channel
  std::optional<double> rate_hz;
  std::optional<std::int64_t> start_ns;    ///< time of row 0, since 1970
  std::optional<std::size_t> time_column;  ///< timestamps, or seconds from start_ns
  std::vector<Note> notes;
};

/// Conversion of a channel's stored values to measured ones: a property of the channel, of its
/// group or of the file. Errors: as Scaling::of().
[[nodiscard]] Result<std::optional<Scaling>> scaling_of(const Map& map, std::uint32_t channel);

/// The scalers of a channel of DAQmx raw data, in the order of the file; empty for any other.
[[nodiscard]] std::vector<std::uint32_t> scalers_of(const Map& map, std::uint32_t channel);

/// Groups the numeric channels into tables: those with the same group, length, rate and start.
/// Groups are never joined, even where they would match: each is a separate measurement to
/// LabVIEW's users. A channel that is short only because the file is truncated stays with the
/// others.
[[nodiscard]] std::vector<Group> group_channels(const Map& map);

/// Contents of unsupported channels, one note for the file; empty if there are none.
[[nodiscard]] std::vector<Note> notes_on_unread(const Map& map);

}  // namespace proofmass::io::tdms
