#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Writes what MAT files of version 5 are made of, little-endian and not compressed.
// Source: The MathWorks, "MAT-File Format" (2019), chapter 1.
namespace proofmass::io {

/// The most figures that a variable of doubles has room for.
inline constexpr std::size_t most_mat5_doubles = ((std::size_t{1} << 31) - 256) / 8;

/// The 128 bytes that the file begins with; `text` is what a person reads there.
[[nodiscard]] std::string mat5_file_header(std::string_view text);

/// All of a column of doubles but its figures, which follow.
[[nodiscard]] std::string mat5_column_head(std::string_view name, std::size_t rows);

/// A single number.
[[nodiscard]] std::string mat5_number(std::string_view name, double value);
[[nodiscard]] std::string mat5_whole_number(std::string_view name, std::int64_t value);

/// A struct of texts.
struct Mat5Text {
  std::string field;  ///< a legal name
  std::string text;   ///< UTF-8
};
[[nodiscard]] std::string mat5_texts(std::string_view name, const std::vector<Mat5Text>& texts);

}  // namespace proofmass::io
