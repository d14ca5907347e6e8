#pragma once

#include <memory>
#include <set>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/io/mcap_catalogue.hpp"
#include "proofmass/io/mcap_decoder.hpp"
#include "proofmass/io/random_bytes.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io {

/// A topic of an MCAP file that is read as a table.
struct McapTableSpec {
  McapTopic topic;
  std::set<std::uint16_t> channels;  ///< all that have this topic, encoding and schema
  std::optional<std::uint64_t> rows;
  bool rows_are_guessed = false;  ///< by the first of its messages, which need not be of one length
  std::vector<Note> notes;        ///< what is told of the file
  /// All channels of the file that are known beforehand, read or not.
  std::shared_ptr<const std::set<std::uint16_t>> known{};
  std::set<std::uint16_t> events{};  ///< channels of events, which are summed up in a note
  /// Gets the attachment with the labels, if there is one, once all rows are read.
  std::shared_ptr<std::string> labels{};
};

/// Reads the rows of a topic. Messages that are damaged are passed over and told.
/// Errors: those of mcap_decoder().
[[nodiscard]] Result<std::unique_ptr<TableReader>> mcap_table(
    std::shared_ptr<const RandomBytes> bytes, McapTableSpec spec, McapWalkHints hints);

}  // namespace proofmass::io
