#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
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

/// How figures travel.
enum class Hdf5Figures { doubles, int64, uint64 };

/// A dataset to be read as samples × columns.
struct Hdf5Request {
  std::string name{};     ///< for people
  std::string address{};  ///< Hdf5Dataset::address
  std::uint64_t rows = 0;
  std::uint64_t width = 0;
  bool is_by_row = true;  ///< time runs along the first dimension, not along the last
  Hdf5Figures figures = Hdf5Figures::doubles;
};

/// Samples that travel together, of datasets that are read side by side: what one of them hands
/// over fits into a frame, what all do into 8 MiB.
[[nodiscard]] inline std::uint64_t rows_a_block(std::span<const Hdf5Request> requests) {
  constexpr std::uint64_t most_figures = most_frame_bytes / sizeof(double);
  std::uint64_t width = 0;
  std::uint64_t widest = 1;
  for (const Hdf5Request& request : requests) {
    width += request.width;
    widest = std::max(widest, request.width);
  }
  return std::max<std::uint64_t>(
      1, std::min(most_figures / widest, 8 * most_figures / std::max<std::uint64_t>(width, 1)));
}

/// Reads equally long datasets side by side: of each in turn a block of rows_a_block() samples (the
/// last of what there is), column by column, then the next block. Of complex numbers the real part,
/// of compound ones the fields that numeric_fields() names.
/// Errors: corrupt (naming dataset and sample).
[[nodiscard]] Status read_hdf5(const Hdf5Source& source,
                               const std::vector<Hdf5Request>& requests,
                               const ByteSink& sink);

}  // namespace proofmass::io
