#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/file_window.hpp"
#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {

/// Information on the data from the end of an MCAP file.
struct Summary {
  std::map<std::uint16_t, std::uint64_t> messages;  ///< per channel
  std::vector<std::uint64_t> chunk_starts;          ///< ascending
  bool has_data_checksum = false;
  std::vector<Schema> schemas;
  std::vector<ChannelRecord> channels;
};

/// Reads the summary that the footer points to; nullopt if there is none, or it does not count the
/// messages of each channel, or it is damaged, which is reported in a note.
/// Errors: unreadable.
[[nodiscard]] Result<std::optional<Summary>> read_summary(FileWindow& window,
                                                          std::vector<Note>& notes);

}  // namespace proofmass::io::mcap
