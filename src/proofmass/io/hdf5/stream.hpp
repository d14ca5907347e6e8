#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/library_file.hpp"
#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"
#include "proofmass/io/hdf5/library.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io::hdf5 {

/// list_datasets() in a child process. Errors: as there; corrupt, unsupported (too many names).
[[nodiscard]] Result<Catalogue> list_in_child(const LibraryFile& file, bool is_matlab);

/// Datasets read in parallel by a child process, one block of rows at a time.
class FigureStream {
 public:
  /// Errors: unsupported (more values than the file can hold), unreadable.
  [[nodiscard]] static Result<FigureStream> start(const LibraryFile& file,
                                                  std::vector<Request> requests);
  /// For tests: a stream of bytes instead of a child process.
  FigureStream(std::vector<Request> requests, BytePump said);

  [[nodiscard]] std::span<const Request> requests() const { return requests_; }
  /// Replaces the current block by the next: number of rows, 0 at the end.
  /// Errors: corrupt (naming dataset and sample, or how the process ended).
  [[nodiscard]] Result<std::size_t> next();
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Values of the block, from `row` on, minus an integer column's origin.
  void copy(std::size_t request, std::size_t column, std::size_t row, std::span<double> into) const;
  /// Makes the first value of an integer column its origin, so that stamps keep all digits.
  Int128 put_origin_at_first(std::size_t request);
  [[nodiscard]] double fraction_read() const;

 private:
  FigureStream(std::vector<Request> requests, Subprocess child);

  [[nodiscard]] Result<std::span<const char>> hear();
  Status take(std::size_t request, std::uint64_t rows);

  std::vector<Request> requests_;
  std::optional<Subprocess> child_;
  std::optional<MessageReader> message_;
  std::vector<std::vector<std::uint64_t>> block_;  ///< bits of the values, one vector per request
  std::vector<Int128> origins_;
  std::size_t rows_ = 0;
  std::uint64_t rows_taken_ = 0;
};

}  // namespace proofmass::io::hdf5
