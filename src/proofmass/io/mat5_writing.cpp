#include "proofmass/io/mat5_writing.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace proofmass::io {
namespace {

enum Type : std::uint32_t {
  mi_int8 = 1,
  mi_uint16 = 4,
  mi_int32 = 5,
  mi_uint32 = 6,
  mi_double = 9,
  mi_int64 = 12,
  mi_matrix = 14,
};
enum Class : std::uint32_t { mx_struct = 2, mx_char = 4, mx_double = 6, mx_int64 = 14 };

template <class T>
void append(std::string& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

/// A data element; one of four bytes or fewer has them in its tag.
std::string element(Type type, std::string_view data) {
  std::string out;
  if (!data.empty() && data.size() <= 4) {
    append(out, static_cast<std::uint32_t>(data.size()) << 16 | type);
    out += data;
  } else {
    append<std::uint32_t>(out, type);
    append(out, static_cast<std::uint32_t>(data.size()));
    out += data;
  }
  out.resize((out.size() + 7) / 8 * 8, '\0');
  return out;
}

/// Class, shape and name of an array.
std::string preface(Class array_class,
                    std::size_t rows,
                    std::size_t columns,
                    std::string_view name) {
  std::string flags;
  append<std::uint32_t>(flags, array_class);
  append<std::uint32_t>(flags, 0);
  std::string shape;
  append(shape, static_cast<std::int32_t>(rows));
  append(shape, static_cast<std::int32_t>(columns));
  return element(mi_uint32, flags) + element(mi_int32, shape) + element(mi_int8, name);
}

std::string matrix_tag(std::size_t size) {
  std::string out;
  append<std::uint32_t>(out, mi_matrix);
  append(out, static_cast<std::uint32_t>(size));
  return out;
}

std::string matrix(const std::string& body) {
  return matrix_tag(body.size()) + body;
}

/// The next character of UTF-8 and how many bytes it takes; a byte that is none stands for itself.
std::uint32_t next_character(std::string_view text, std::size_t& length) {
  const auto lead = static_cast<unsigned char>(text[0]);
  length = lead < 0xC0 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  const std::uint32_t mask = length == 1 ? 0xFF : 0x7Fu >> length;
  std::uint32_t character = lead & mask;
  for (std::size_t i = 1; i < length; ++i) {
    const bool goes_on = i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
    if (!goes_on) {
      length = 1;
      return lead;
    }
    character = character << 6 | (static_cast<unsigned char>(text[i]) & 0x3Fu);
  }
  return character;
}

std::string utf16_of(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t length = 0;
    const std::uint32_t character = next_character(text, length);
    text.remove_prefix(length);
    if (character < 0x10000) {
      append(out, static_cast<std::uint16_t>(character));
    } else {
      append(out, static_cast<std::uint16_t>(0xD800 + ((character - 0x10000) >> 10 & 0x3FF)));
      append(out, static_cast<std::uint16_t>(0xDC00 + (character & 0x3FF)));
    }
  }
  return out;
}

}  // namespace

std::string mat5_file_header(std::string_view text) {
  std::string header = "MATLAB 5.0 MAT-file, ";
  header += text;
  header.resize(116, ' ');
  header.append(8, '\0');
  append<std::uint16_t>(header, 0x0100);
  append<std::uint16_t>(header, 'M' << 8 | 'I');
  return header;
}

std::string mat5_column_head(std::string_view name, std::size_t rows) {
  std::string body = preface(mx_double, rows, 1, name);
  append<std::uint32_t>(body, mi_double);
  append(body, static_cast<std::uint32_t>(rows * sizeof(double)));
  return matrix_tag(body.size() + rows * sizeof(double)) + body;
}

std::string mat5_number(std::string_view name, double value) {
  std::string out = mat5_column_head(name, 1);
  append(out, value);
  return out;
}

std::string mat5_whole_number(std::string_view name, std::int64_t value) {
  std::string figure;
  append(figure, value);
  return matrix(preface(mx_int64, 1, 1, name) + element(mi_int64, figure));
}

std::string mat5_texts(std::string_view name, const std::vector<Mat5Text>& texts) {
  constexpr std::size_t field_bytes = 64;
  std::string length;
  append(length, static_cast<std::int32_t>(field_bytes));
  std::string fields;
  std::string values;
  for (const Mat5Text& text : texts) {
    fields += text.field;
    fields.resize((fields.size() / field_bytes + 1) * field_bytes, '\0');
    const std::string characters = utf16_of(text.text);
    const std::size_t count = characters.size() / 2;
    values +=
        matrix(preface(mx_char, count > 0 ? 1 : 0, count, "") + element(mi_uint16, characters));
  }
  return matrix(preface(mx_struct, 1, 1, name) + element(mi_int32, length) +
                element(mi_int8, fields) + values);
}

}  // namespace proofmass::io
