#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/tdms/channel_groups.hpp"
#include "proofmass/io/tdms/map.hpp"

namespace proofmass::io {

/// An open TDMS file, shared by its tables.
struct TdmsContents {
  std::unique_ptr<const RandomBytes> bytes;
  TdmsMap map;
  std::vector<TdmsGroup> groups;
  std::vector<Note> notes;  ///< about the file, whichever table is read
};

/// One table of a file, its values scaled as specified in the file.
/// Errors: unreadable, corrupt.
[[nodiscard]] Result<std::unique_ptr<TableReader>> open_tdms_table(
    std::shared_ptr<const TdmsContents> contents, std::size_t group);

/// Maps a file and groups its channels. Errors: as open_tdms().
[[nodiscard]] Result<std::shared_ptr<const TdmsContents>> read_tdms_contents(
    std::unique_ptr<const RandomBytes> bytes);

}  // namespace proofmass::io
