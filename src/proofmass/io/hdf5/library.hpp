#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"

// Calls of the HDF5 library. It has global state and can crash on damaged files: these functions
// are called in a child process only.
namespace proofmass::io::hdf5 {

/// True if the library was available at build time; if not, the other two return unsupported.
[[nodiscard]] bool has_library();

/// A file to open.
struct Source {
  std::string path;
  bool is_nameless = false;  ///< the path leads to an unnamed file in memory
};

/// Lists the datasets of a file, its groups 16 levels deep, with attributes; links to other files
/// are not followed. For a MAT file of version 7.3, lists the variables, including those in structs
/// and cells. Afterwards the process can open no other file.
/// Errors: corrupt (with the library's reason).
[[nodiscard]] Result<Catalogue> list_datasets(const Source& source, bool is_matlab);

/// Transfer format of the values.
enum class Figures { doubles, int64, uint64 };

/// A dataset to read as samples × columns.
struct Request {
  std::string name{};     ///< for display
  std::string address{};  ///< Dataset::address
  std::uint64_t rows = 0;
  std::uint64_t width = 0;
  bool is_by_row = true;  ///< time runs along the first dimension, not along the last
  Figures figures = Figures::doubles;
};

/// Number of samples transferred together, for datasets read in parallel: those of one dataset fit
/// into a frame, those of all into 8 MiB.
[[nodiscard]] inline std::uint64_t rows_a_block(std::span<const Request> requests) {
  constexpr std::uint64_t most_figures = most_frame_bytes / sizeof(double);
  std::uint64_t width = 0;
  std::uint64_t widest = 1;
  for (const Request& request : requests) {
    width += request.width;
    widest = std::max(widest, request.width);
  }
  return std::max<std::uint64_t>(
      1, std::min(most_figures / widest, 8 * most_figures / std::max<std::uint64_t>(width, 1)));
}

/// Reads datasets of equal length in parallel: for each in turn a block of rows_a_block() samples
/// (or the remaining ones), column by column, then the next block. For complex numbers the real
/// part, for compound ones the fields of numeric_fields().
/// Errors: corrupt (naming dataset and sample).
[[nodiscard]] Status read_values(const Source& source,
                                 const std::vector<Request>& requests,
                                 const ByteSink& sink);

}  // namespace proofmass::io::hdf5
