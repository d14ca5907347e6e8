#include "proofmass/io/matlab/mat5_writing.hpp"

#include "proofmass/core/utf8.hpp"
#include "proofmass/io/bytes/little_endian.hpp"

namespace proofmass::io::matlab {
namespace {

enum Type : std::uint32_t {
  mi_int8 = 1,
  mi_int32 = 5,
  mi_uint32 = 6,
  mi_double = 9,
  mi_int64 = 12,
  mi_matrix = 14,
  mi_utf8 = 16,
};
enum Class : std::uint32_t { mx_struct = 2, mx_char = 4, mx_double = 6, mx_int64 = 14 };

/// A data element; up to four bytes are stored in its tag.
std::string element(Type type, std::string_view data) {
  std::string out;
  if (!data.empty() && data.size() <= 4) {
    append_value(out, static_cast<std::uint32_t>(data.size()) << 16 | type);
    out += data;
  } else {
    append_value<std::uint32_t>(out, type);
    append_value(out, static_cast<std::uint32_t>(data.size()));
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
  append_value<std::uint32_t>(flags, array_class);
  append_value<std::uint32_t>(flags, 0);
  std::string shape;
  append_value(shape, static_cast<std::int32_t>(rows));
  append_value(shape, static_cast<std::int32_t>(columns));
  return element(mi_uint32, flags) + element(mi_int32, shape) + element(mi_int8, name);
}

std::string matrix_tag(std::size_t size) {
  std::string out;
  append_value<std::uint32_t>(out, mi_matrix);
  append_value(out, static_cast<std::uint32_t>(size));
  return out;
}

std::string matrix(const std::string& body) {
  return matrix_tag(body.size()) + body;
}

/// A text as stored by MATLAB: its bytes in UTF-8, and its length in UTF-16 units.
struct StoredText {
  std::string bytes;
  std::size_t units = 0;
};
StoredText stored(std::string_view text) {
  StoredText out;
  while (!text.empty()) {
    std::size_t length = 0;
    const std::uint32_t character = next_character(text, length);
    text.remove_prefix(length);
    append_utf8(out.bytes, character);
    out.units += character < 0x10000 ? 1 : 2;
  }
  return out;
}

}  // namespace

std::string mat5_file_header(std::string_view text) {
  std::string header = "MATLAB 5.0 MAT-file, ";
  header += text;
  header.resize(116, ' ');
  header.append(8, '\0');
  append_value<std::uint16_t>(header, 0x0100);
  append_value<std::uint16_t>(header, 'M' << 8 | 'I');
  return header;
}

std::string mat5_column_head(std::string_view name, std::size_t rows) {
  std::string body = preface(mx_double, rows, 1, name);
  append_value<std::uint32_t>(body, mi_double);
  append_value(body, static_cast<std::uint32_t>(rows * sizeof(double)));
  return matrix_tag(body.size() + rows * sizeof(double)) + body;
}

std::string mat5_number(std::string_view name, double value) {
  std::string out = mat5_column_head(name, 1);
  append_value(out, value);
  return out;
}

std::string mat5_whole_number(std::string_view name, std::int64_t value) {
  std::string figure;
  append_value(figure, value);
  return matrix(preface(mx_int64, 1, 1, name) + element(mi_int64, figure));
}

std::string mat5_texts(std::string_view name, const std::vector<Mat5Text>& texts) {
  constexpr std::size_t field_bytes = 64;
  std::string length;
  append_value(length, static_cast<std::int32_t>(field_bytes));
  std::string fields;
  std::string values;
  for (const Mat5Text& text : texts) {
    fields += text.field;
    fields.resize((fields.size() / field_bytes + 1) * field_bytes, '\0');
    const StoredText characters = stored(text.text);
    values += matrix(preface(mx_char, characters.units > 0 ? 1 : 0, characters.units, "") +
                     element(mi_utf8, characters.bytes));
  }
  return matrix(preface(mx_struct, 1, 1, name) + element(mi_int32, length) +
                element(mi_int8, fields) + values);
}

}  // namespace proofmass::io::matlab
