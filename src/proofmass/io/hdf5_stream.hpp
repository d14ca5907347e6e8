#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/hdf5_catalogue.hpp"
#include "proofmass/io/hdf5_library.hpp"
#include "proofmass/io/library_file.hpp"
#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/watched_child.hpp"

namespace proofmass::io {

/// list_hdf5() in a process of its own. Errors: as there; corrupt, unsupported (too many names).
[[nodiscard]] Result<Hdf5Catalogue> list_in_child(const LibraryFile& file, bool is_matlab);

/// Datasets read side by side by a process of their own, a block of rows at a time.
class FigureStream {
 public:
  /// Errors: unsupported (more figures than the file has room for), unreadable.
  [[nodiscard]] static Result<FigureStream> start(const LibraryFile& file,
                                                  std::vector<Hdf5Request> requests);
  /// For what a child might say: the stream of bytes in place of a process.
  FigureStream(std::vector<Hdf5Request> requests, ByteFeed said);

  [[nodiscard]] std::span<const Hdf5Request> requests() const { return requests_; }
  /// Takes the next block in place of the one there is: its rows, 0 at the end.
  /// Errors: corrupt (naming dataset and sample, or how the process ended).
  [[nodiscard]] Result<std::size_t> next();
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Figures of the block, from `row` on, less an integer column's origin.
  void copy(std::size_t request, std::size_t column, std::size_t row, std::span<double> into) const;
  /// The first figure of an integer column becomes its origin, so that stamps keep every digit.
  Int128 put_origin_at_first(std::size_t request);
  [[nodiscard]] double fraction_read() const;

 private:
  FigureStream(std::vector<Hdf5Request> requests, WatchedChild child);

  [[nodiscard]] Result<std::span<const char>> hear();
  Status take(std::size_t request, std::uint64_t rows);

  std::vector<Hdf5Request> requests_;
  std::optional<WatchedChild> child_;
  std::optional<MessageReader> message_;
  std::vector<std::vector<std::uint64_t>> block_;  ///< figures' bits, a request each
  std::vector<Int128> origins_;
  std::size_t rows_ = 0;
  std::uint64_t rows_taken_ = 0;
};

}  // namespace proofmass::io
