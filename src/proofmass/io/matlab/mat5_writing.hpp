#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Writes the elements of MAT files of version 5, little-endian and uncompressed.
// Source: The MathWorks, "MAT-File Format" (2019), chapter 1.
namespace proofmass::io::matlab {

/// Maximum number of values in a variable of doubles.
inline constexpr std::size_t most_mat5_doubles = ((std::size_t{1} << 31) - 256) / 8;

/// The first 128 bytes of the file; `text` is its human-readable part.
[[nodiscard]] std::string mat5_file_header(std::string_view text);

/// A column of doubles without its values, which follow.
[[nodiscard]] std::string mat5_column_head(std::string_view name, std::size_t rows);

/// A scalar.
[[nodiscard]] std::string mat5_number(std::string_view name, double value);
[[nodiscard]] std::string mat5_whole_number(std::string_view name, std::int64_t value);

/// A struct of texts.
struct Mat5Text {
  std::string field;  ///< a valid MATLAB name
  std::string text;   ///< UTF-8
};
[[nodiscard]] std::string mat5_texts(std::string_view name, const std::vector<Mat5Text>& texts);

}  // namespace proofmass::io::matlab
