#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/lvm/header.hpp"
#include "proofmass/io/lvm/table.hpp"

namespace proofmass::io::lvm {

/// Contents of a file.
struct Contents {
  File file;
  std::vector<Table> tables;  ///< those with rows
  std::vector<Note> notes;
};

/// Reads the headers and locates the rows. Errors: corrupt (no segment), unreadable.
[[nodiscard]] Result<Contents> list_segments(const RandomBytes& file, const Progress& progress);

}  // namespace proofmass::io::lvm
