#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A line of a text, without its end.
struct TextLine {
  std::size_t number = 0;  ///< 1 = first of the file
  std::string text;
};

/// The lines of a short text that a person wrote, less those that are blank or remarks; LF, CRLF or
/// CR ends them. Compressed files open as they are; `path` "-" is standard input.
/// Errors: unreadable, corrupt (longer than 16 MiB), too_few_samples (nothing in it).
[[nodiscard]] Result<std::vector<TextLine>> read_lines(const std::string& path);
[[nodiscard]] Result<std::vector<TextLine>> read_lines(std::span<const std::byte> bytes);

}  // namespace proofmass::io
