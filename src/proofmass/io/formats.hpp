#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// A file format: how it is recognised and how it is read. A format is added by a file with these
/// two functions and a line in formats.cpp.
struct Format {
  std::string_view name;
  /// By the first few KiB, and only where they do not tell by the file's name.
  bool (*claims)(std::string_view head, std::string_view file_name);
  Result<std::unique_ptr<TableFile>> (*open)(std::unique_ptr<PeekSource> source,
                                             const ReadOptions& options);
  bool has_variables = false;  ///< whether it reads ReadOptions::variables itself
};

/// All formats, the most particular first: the first that claims a file reads it. The last claims
/// everything.
[[nodiscard]] std::span<const Format> formats();

/// Opens a file of whatever format its bytes are, and what is compressed unpacked; `name` decides
/// only where they do not. Errors: those of the format, without the name.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_tables(std::unique_ptr<ByteSource> bytes,
                                                             const std::string& name,
                                                             const ReadOptions& options);

}  // namespace proofmass::io
