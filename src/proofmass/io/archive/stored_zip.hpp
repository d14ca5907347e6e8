#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/output_file.hpp"

namespace proofmass::io {

/// Writes a zip archive with uncompressed entries.
/// Source: PKWARE, APPNOTE.TXT 6.3.10, sections 4.3 and 4.4.
class StoredZipWriter {
 public:
  explicit StoredZipWriter(std::unique_ptr<OutputFile> file) : file_(std::move(file)) {}

  /// Errors: those of the file; unsupported (the archive would have 4 GiB or more).
  [[nodiscard]] Status add(const std::string& name, std::string_view head, std::string_view bytes);
  /// Writes the directory and names the file.
  [[nodiscard]] Status finish();

 private:
  struct Entry {
    std::string name;
    std::uint32_t offset = 0;
    std::uint32_t crc = 0;
    std::uint32_t size = 0;
  };

  std::unique_ptr<OutputFile> file_;
  std::vector<Entry> entries_;
};

}  // namespace proofmass::io
