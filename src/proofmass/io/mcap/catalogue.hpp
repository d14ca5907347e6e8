#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/mcap/records.hpp"
#include "proofmass/io/mcap/walk.hpp"

namespace proofmass::io::mcap {

/// A message that a decoder can inspect before the rows are read.
struct FirstMessage {
  std::uint64_t log_ns = 0;
  std::string data;  ///< its first mebibyte
};

/// Contents of an MCAP file.
struct Catalogue {
  std::string profile;
  std::string library;  ///< the library that wrote it
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, ChannelRecord> channels;
  std::map<std::uint16_t, std::uint64_t> messages;  ///< per channel; according to the summary
  std::map<std::uint16_t, FirstMessage> firsts;
  WalkHints hints;
  std::vector<Note> notes;   ///< about the summary
  std::vector<Note> damage;  ///< about the records, if all of them were read
};

/// Reads the summary if it is intact, and the records from the beginning: up to the first message
/// of each channel with messages according to the summary; all records without a summary. Schemas
/// and messages are kept up to 64 MiB in all.
/// Errors: unreadable, corrupt (damaged before the first record).
[[nodiscard]] Result<Catalogue> read_catalogue(const std::shared_ptr<const RandomBytes>& bytes);

}  // namespace proofmass::io::mcap
