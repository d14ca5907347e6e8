#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// A file format: its detection and its reader. To add a format, add a file with these two
/// functions and a line in formats.cpp.
struct Format {
  std::string_view name;
  /// By the first few KiB, and by the file's name only if these are ambiguous.
  bool (*claims)(std::string_view head, std::string_view file_name);
  Result<std::unique_ptr<TableFile>> (*open)(std::unique_ptr<PeekSource> source,
                                             const ReadOptions& options);
  bool has_variables = false;  ///< true if it handles ReadOptions::variables itself
};

/// All formats, the most specific first: the first that claims a file reads it. The last claims
/// everything.
[[nodiscard]] std::span<const Format> formats();

/// Opens a file in the format of its bytes, decompressed; `name` decides only if they are
/// ambiguous. Errors: those of the format, without the name.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_tables(std::unique_ptr<ByteSource> bytes,
                                                             const std::string& name,
                                                             const ReadOptions& options);

}  // namespace proofmass::io
