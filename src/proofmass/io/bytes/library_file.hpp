#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"

namespace proofmass::io {

/// An open file that a library can open by its path during the lifetime of this object.
class LibraryFile {
 public:
  LibraryFile(int descriptor, bool is_nameless)
      : descriptor_(descriptor), is_nameless_(is_nameless) {}
  LibraryFile(LibraryFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), is_nameless_(other.is_nameless_) {}
  LibraryFile(const LibraryFile&) = delete;
  LibraryFile& operator=(const LibraryFile&) = delete;
  LibraryFile& operator=(LibraryFile&&) = delete;
  ~LibraryFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Path valid while it is open.
  [[nodiscard]] std::string path() const;
  /// True if it is in memory, not in a folder.
  [[nodiscard]] bool is_nameless() const { return is_nameless_; }
  [[nodiscard]] std::uint64_t size() const;

 private:
  int descriptor_;
  bool is_nameless_;
};

/// The bytes of a stream as a file: the underlying one, or one in memory, up to 4 GiB.
/// Errors: those of the stream; unsupported (larger); unreadable (no memory).
[[nodiscard]] Result<LibraryFile> library_file_of(PeekSource& source, const Progress& progress);

}  // namespace proofmass::io
