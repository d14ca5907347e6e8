#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/byte_source.hpp"

namespace proofmass::io {

/// An open file that a library can open by its path, for as long as this lives.
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
  /// Which leads to it as long as it is open.
  [[nodiscard]] std::string path() const;
  /// Whether it lies in no folder, but in memory.
  [[nodiscard]] bool is_nameless() const { return is_nameless_; }
  [[nodiscard]] std::uint64_t size() const;

 private:
  int descriptor_;
  bool is_nameless_;
};

/// The bytes of a stream as a file: the one that it is, or one in memory, up to 4 GiB.
/// Errors: those of the stream; unsupported (more than that); unreadable (no memory).
[[nodiscard]] Result<LibraryFile> library_file_of(PeekSource& source, const Progress& progress);

}  // namespace proofmass::io
