#pragma once

#include <span>
#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// A file format: how it is recognised and how it is read. A format is added by a file with these
/// two functions and a line in formats.cpp.
struct Format {
  std::string_view name;
  /// By the first few KiB, and only where they do not tell by the file's name.
  bool (*claims)(std::string_view head, std::string_view file_name);
  Result<Recording> (*read)(PeekSource& source, const ReadOptions& options);
  bool has_variables = false;  ///< whether ReadOptions::variables means anything to it
};

/// All formats, the most particular first: the first that claims a file reads it. The last claims
/// everything.
[[nodiscard]] std::span<const Format> formats();

}  // namespace proofmass::io
