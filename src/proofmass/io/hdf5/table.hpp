#pragma once

#include <memory>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/library_file.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"
#include "proofmass/io/matlab/mat_catalogue.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io::hdf5 {

/// An open HDF5 file and its contents.
struct OpenFile {
  LibraryFile file;
  Catalogue catalogue{};
  std::vector<matlab::Array> arrays{};  ///< arrays_of(catalogue)
  std::vector<Note> notes{};            ///< about decompression
  bool is_matlab = false;               ///< version 7.3
};

/// Selects the datasets of the recording and starts to read them. `file` need not outlive the
/// reader. Errors: those of open().
[[nodiscard]] Result<std::unique_ptr<TableReader>> open_table(const OpenFile& file,
                                                              const ReadOptions& options);

}  // namespace proofmass::io::hdf5
