#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/arrays/figure_type.hpp"
#include "proofmass/io/matlab/mat_stream.hpp"

namespace proofmass::io::matlab {

/// Types of data elements that a reader must distinguish.
inline constexpr std::uint32_t mi_matrix = 14;
inline constexpr std::uint32_t mi_compressed = 15;
inline constexpr std::size_t tag_bytes = 8;

/// Classes of arrays.
enum class Class : unsigned {
  cell = 1,
  structure = 2,
  object = 3,
  text = 4,
  sparse = 5,
  double_precision = 6,
  uint64 = 15,
  function = 16,
  opaque = 17,
};

/// Type and length of a data element, with the data if these are in the tag itself.
struct Tag {
  std::uint64_t at = 0;     ///< position of the tag
  std::uint64_t begin = 0;  ///< position of the data
  std::uint32_t type = 0;
  std::uint32_t size = 0;
  bool is_small = false;
  std::array<char, 4> data{};
};

/// Description of an array before its content.
struct Preface {
  Class array_class{};
  bool is_complex = false;
  bool is_logical = false;
  std::vector<std::size_t> shape;  ///< empty for opaque objects
  std::size_t count = 1;           ///< product of the shape
  std::string name;
};

/// The unsigned number of four bytes.
[[nodiscard]] std::uint32_t word_at(const char* bytes, bool big_endian);

/// Storage of the numbers of an element; nullopt if its type is not numeric.
[[nodiscard]] std::optional<FigureType> figure_type(std::uint32_t type, bool big_endian);

/// Reads the data elements of one variable. Each length is checked against the remainder of the
/// enclosing element, `end`. Errors of all functions: corrupt.
class Mat5Elements {
 public:
  Mat5Elements(Stream& stream, bool big_endian) : stream_(stream), big_endian_(big_endian) {}

  /// A tag, which must lie before `end` with all of its data.
  [[nodiscard]] Result<Tag> tag(std::uint64_t end);
  /// Skips to the next element, after the data of this one are read.
  Status skip_padding(const Tag& tag, std::uint64_t end);
  /// Class, shape and name of an array.
  [[nodiscard]] Result<Preface> preface(std::uint64_t end);
  /// The names of a struct's fields.
  [[nodiscard]] Result<std::vector<std::string>> field_names(std::uint64_t end);
  /// Characters of one byte, UTF-8 or UTF-16, as UTF-8; at most `most` bytes.
  [[nodiscard]] Result<std::string> text(std::uint64_t end, std::size_t most);

 private:
  [[nodiscard]] Result<std::string> words(std::uint64_t end, std::size_t most);
  [[nodiscard]] Result<std::string> characters(std::uint64_t end, std::size_t most);
  [[nodiscard]] Result<std::string> data(const Tag& tag, std::uint64_t end, std::size_t most);
  Status read_class(Preface& preface, std::uint64_t end);
  Status read_shape(Preface& preface, std::uint64_t end);

  Stream& stream_;
  bool big_endian_;
};

}  // namespace proofmass::io::matlab
