#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/random_bytes.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/tdms_map.hpp"
#include "proofmass/io/tdms_tables.hpp"

namespace proofmass::io {

/// An open TDMS file, which its tables share.
struct TdmsContents {
  std::unique_ptr<const RandomBytes> bytes;
  TdmsMap map;
  std::vector<TdmsGroup> groups;
  std::vector<Note> notes;  ///< what is to be told of the file whichever table is read
};

/// One table of a file, its values scaled as the file says.
/// Errors: unreadable, corrupt.
[[nodiscard]] Result<std::unique_ptr<TableReader>> open_tdms_table(
    std::shared_ptr<const TdmsContents> contents, std::size_t group);

/// Maps a file and sorts its channels. Errors: as open_tdms().
[[nodiscard]] Result<std::shared_ptr<const TdmsContents>> read_tdms_contents(
    std::unique_ptr<const RandomBytes> bytes);

}  // namespace proofmass::io
