#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"

namespace proofmass::io {

/// A file in a folder or a zip archive.
struct ArchiveEntry {
  std::string name;  ///< path below the top, separated by '/'
  std::uint64_t size = 0;
};

/// A folder or a zip archive, with the same interface.
class Archive {
 public:
  Archive() = default;
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  virtual ~Archive() = default;

  /// Sorted by name.
  [[nodiscard]] virtual std::span<const ArchiveEntry> entries() const = 0;
  /// The bytes of an entry, decompressed, including inner compression (gz, xz), and converted from
  /// UTF-16. May outlive the archive. Errors: corrupt, unreadable, unsupported (encrypted, an
  /// unknown method).
  [[nodiscard]] virtual Result<std::unique_ptr<PeekSource>> open(std::size_t entry) = 0;
};

/// Two levels of a folder. Errors: unreadable.
[[nodiscard]] Result<std::unique_ptr<Archive>> open_folder(const std::string& path);
/// Errors: corrupt.
[[nodiscard]] Result<std::unique_ptr<Archive>> open_zip(std::unique_ptr<RandomBytes> bytes);

}  // namespace proofmass::io
