#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A file being written: a NewFile, which is named by keep() and otherwise removed. Path "-" is
/// standard output, which does not support overwrite().
class OutputFile {
 public:
  OutputFile() = default;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  virtual ~OutputFile() = default;

  /// Errors of all functions: unwritable, "<path>: cannot be written: No space left on device".
  [[nodiscard]] virtual Status append(std::string_view bytes) = 0;
  /// Overwrites earlier bytes; must end within them.
  [[nodiscard]] virtual Status overwrite(std::uint64_t offset, std::string_view bytes) = 0;
  [[nodiscard]] virtual std::uint64_t size() const = 0;  ///< bytes appended
  /// NewFile::part_path(), for libraries that write files themselves.
  [[nodiscard]] virtual const std::string& part_path() const = 0;
  [[nodiscard]] virtual Status keep() = 0;
};

[[nodiscard]] Result<std::unique_ptr<OutputFile>> create_file(const std::string& path);

/// The same file, compressed by gzip; does not support overwrite().
[[nodiscard]] std::unique_ptr<OutputFile> gzipped(std::unique_ptr<OutputFile> file);

}  // namespace proofmass::io
