#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/tdms/channel_groups.hpp"
#include "proofmass/io/tdms/map.hpp"

namespace proofmass::io::tdms {

/// An open TDMS file, shared by its tables.
struct Contents {
  std::unique_ptr<const RandomBytes> bytes;
  Map map;
  std::vector<Group> groups;
  std::vector<Note> notes;  ///< about the file, whichever table is read
};

/// One table of a file, its values scaled as specified in the file.
/// Errors: unreadable, corrupt.
[[nodiscard]] Result<std::unique_ptr<TableReader>> open_table(
    std::shared_ptr<const Contents> contents, std::size_t group);

/// Maps a file and groups its channels. Errors: as open().
[[nodiscard]] Result<std::shared_ptr<const Contents>> read_contents(
    std::unique_ptr<const RandomBytes> bytes);

}  // namespace proofmass::io::tdms
