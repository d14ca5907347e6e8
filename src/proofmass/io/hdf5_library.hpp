#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/hdf5_catalogue.hpp"
#include "proofmass/io/watched_child.hpp"

// What is asked of the HDF5 library. It has global state and does not stand up to every file:
// these are called in a child process and nowhere else.
namespace proofmass::io {

/// Whether it was there when this was built; where not, the other two return unsupported.
[[nodiscard]] bool has_hdf5_library();

/// A file to open.
struct Hdf5Source {
  std::string path;
  bool is_nameless = false;  ///< the path leads to it, but it lies in no folder: held in memory
};

/// Lists the datasets of a file, its groups 16 levels deep, with attributes; links into other files
/// are not followed. Of a MAT file of version 7.3 the variables, looking into structs and cells.
/// After it has opened the file the process can open no other.
/// Errors: corrupt (with the library's reason).
[[nodiscard]] Result<Hdf5Catalogue> list_hdf5(const Hdf5Source& source, bool is_matlab);

/// A dataset to be read as samples × columns.
struct Hdf5Request {
  std::string name;     ///< for people
  std::string address;  ///< Hdf5Dataset::address
  std::uint64_t rows = 0;
  std::uint64_t width = 0;
  bool is_by_row = true;  ///< time runs along the first dimension, not along the last
};

/// Samples that travel together.
[[nodiscard]] inline std::uint64_t rows_a_block(std::uint64_t width) {
  return most_frame_bytes / sizeof(double) / width;
}

/// Reads datasets one after another, each in blocks of rows_a_block() samples (the last of what
/// there is), a block column by column, as doubles. Of complex numbers the real part.
/// Errors: corrupt (naming dataset and sample).
[[nodiscard]] Status read_hdf5(const Hdf5Source& source,
                               const std::vector<Hdf5Request>& requests,
                               const ByteSink& sink);

}  // namespace proofmass::io
