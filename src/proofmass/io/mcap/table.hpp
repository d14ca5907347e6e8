#pragma once

#include <memory>
#include <set>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/mcap/catalogue.hpp"
#include "proofmass/io/mcap/decoder.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io::mcap {

/// A topic of an MCAP file, read as a table.
struct TableSpec {
  Topic topic;
  std::set<std::uint16_t> channels;  ///< all that have this topic, encoding and schema
  std::optional<std::uint64_t> rows;
  bool rows_are_guessed = false;  ///< from the first message; others may have another length
  std::vector<Note> notes;        ///< about the file
  /// All channels of the file that are known in advance, whether read or not.
  std::shared_ptr<const std::set<std::uint16_t>> known{};
  std::set<std::uint16_t> events{};  ///< channels of events, which are summarised in a note
  /// Receives the attachment with the labels, if there is one, once all rows are read.
  std::shared_ptr<std::string> labels{};
};

/// Reads the rows of a topic. Damaged messages are skipped and reported.
/// Errors: those of decoder_of().
[[nodiscard]] Result<std::unique_ptr<TableReader>> open_table(
    std::shared_ptr<const RandomBytes> bytes, TableSpec spec, WalkHints hints);

}  // namespace proofmass::io::mcap
