#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/mcap_records.hpp"
#include "proofmass/io/mcap_walk.hpp"
#include "proofmass/io/random_bytes.hpp"

namespace proofmass::io {

/// A message that a reader of its encoding can look at before the rows are read.
struct McapFirstMessage {
  std::uint64_t log_ns = 0;
  std::string data;  ///< its first mebibyte
};

/// What an MCAP file holds.
struct McapCatalogue {
  std::string profile;
  std::string library;  ///< that wrote it
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::map<std::uint16_t, std::uint64_t> messages;  ///< of each channel; as the summary says
  std::map<std::uint16_t, McapFirstMessage> firsts;
  McapWalkHints hints;
  std::vector<Note> notes;   ///< of the summary
  std::vector<Note> damage;  ///< of the records, where all of them were looked at
};

/// Reads the summary where it is whole, and the records from the front: up to the first message of
/// each channel that the summary counts messages of; all of them without a summary.
/// Schemas and messages are kept up to 64 MiB in all.
/// Errors: unreadable, corrupt (damaged before the first record).
[[nodiscard]] Result<McapCatalogue> read_mcap_catalogue(std::shared_ptr<const RandomBytes> bytes);

}  // namespace proofmass::io
