#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A line of a text, without its line end.
struct TextLine {
  std::size_t number = 0;  ///< 1 = first of the file
  std::string text;
};

/// The lines of a short text file, without blank lines and comments; LF, CRLF or CR ends them.
/// Compressed files are supported; `path` "-" is standard input.
/// Errors: unreadable, corrupt (longer than 16 MiB), too_few_samples (empty).
[[nodiscard]] Result<std::vector<TextLine>> read_lines(const std::string& path);
[[nodiscard]] Result<std::vector<TextLine>> read_lines(std::span<const std::byte> bytes);

}  // namespace proofmass::io
