#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>

#include "proofmass/io/matlab/mat_catalogue.hpp"

namespace proofmass::io::matlab {
namespace {

enum class Content { numbers, text, sparse };

/// Parsed header of a variable.
struct Header {
  int machine = 0;  ///< 0: IEEE little-endian, 1: big-endian, 2 to 4: VAX and Cray
  Content content = Content::numbers;
  std::string_view class_name;
  FigureType type;
  std::size_t rows = 0;
  std::size_t columns = 0;
  bool is_complex = false;
  std::string name;
  std::size_t bytes = 0;  ///< size of the header, including the name
};

struct Precision {
  std::string_view class_name;
  char kind;
  std::size_t bytes;
};
constexpr std::array precisions = std::to_array<Precision>({
    {"double", 'f', 8},
    {"single", 'f', 4},
    {"int32", 'i', 4},
    {"int16", 'i', 2},
    {"uint16", 'u', 2},
    {"uint8", 'u', 1},
});

std::size_t whole(std::string_view bytes, std::size_t word, bool big_endian) {
  const FigureType type{'u', 4, big_endian};
  return static_cast<std::size_t>(load_figure(bytes.data() + 4 * word, type));
}

/// The machine from the header's first number, which is below 5000 in one byte order only.
std::optional<int> machine_of(std::string_view bytes) {
  const std::size_t big = whole(bytes, 0, true);
  if (big >= 1000 && big < 2000) return 1;
  const std::size_t little = whole(bytes, 0, false);
  if (little >= 5000 || little / 1000 == 1) return std::nullopt;
  return static_cast<int>(little / 1000);
}

bool is_identifier(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !name.empty() && is_letter(name.front()) && std::ranges::all_of(name, [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

/// nullopt if the bytes are not such a header.
std::optional<Header> read_header(std::string_view bytes) {
  constexpr std::size_t fixed = 20;
  constexpr std::size_t longest_name = 256;
  if (bytes.size() < fixed) return std::nullopt;
  const auto machine = machine_of(bytes);
  if (!machine) return std::nullopt;
  const bool big_endian = *machine == 1;
  const std::size_t kind = whole(bytes, 0, big_endian) % 1000;
  const std::size_t name_bytes = whole(bytes, 4, big_endian);
  const bool is_known = kind / 10 < precisions.size() && kind % 10 <= 2 &&
                        whole(bytes, 3, big_endian) <= 1 && name_bytes <= longest_name;
  if (!is_known || bytes.size() < fixed + name_bytes) return std::nullopt;
  Header header;
  header.name = name_from(bytes.substr(fixed, name_bytes));
  if (!is_identifier(header.name)) return std::nullopt;
  const Precision& precision = precisions[kind / 10];
  header.machine = *machine;
  header.content = static_cast<Content>(kind % 10);
  header.class_name = precision.class_name;
  header.type = {precision.kind, precision.bytes, big_endian};
  header.rows = whole(bytes, 1, big_endian);
  header.columns = whole(bytes, 2, big_endian);
  header.is_complex = whole(bytes, 3, big_endian) == 1;
  header.bytes = fixed + name_bytes;
  return header;
}

/// Size of the values; nullopt if larger than any file.
std::optional<std::size_t> figure_bytes(const Header& header) {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(header.rows, header.columns, &bytes) ||
      __builtin_mul_overflow(bytes, header.type.bytes * (header.is_complex ? 2 : 1), &bytes))
    return std::nullopt;
  return bytes;
}

void add(const Header& header, const Region& region, Catalogue& catalogue) {
  if (catalogue.arrays.size() + catalogue.skipped.size() >= most_arrays) {
    catalogue.is_cut = true;
    return;
  }
  if (header.content != Content::numbers) {
    const char* what = header.content == Content::text ? "text" : "sparse";
    catalogue.skipped.push_back(fmt::format("{} ({})", header.name, what));
    return;
  }
  Array array;
  array.path = header.name;
  array.class_name = header.class_name;
  array.shape = {header.rows, header.columns};
  array.is_complex = header.is_complex;
  array.region = region;
  array.stored = header.type;
  catalogue.arrays.push_back(std::move(array));
}

}  // namespace

bool is_mat4(std::string_view head) {
  return read_header(head).has_value();
}

Result<Catalogue> list_mat4(std::string_view file) {
  Catalogue catalogue;
  catalogue.version = "MAT v4";
  for (std::size_t offset = 0; offset < file.size();) {
    const auto header = read_header(file.substr(offset));
    if (!header)
      return Error{Errc::corrupt,
                   fmt::format("byte {}: no variable begins here, or the file breaks off", offset)};
    if (header->machine > 1)
      return Error{Errc::unsupported,
                   "is a MAT v4 file of a VAX or Cray, whose numbers are not read: save it again "
                   "with save(…, '-v7')"};
    const auto wanted = figure_bytes(*header);
    const std::size_t begin = offset + header->bytes;
    const std::size_t left = file.size() - begin;
    if (!wanted || *wanted > left)
      return Error{
          Errc::corrupt,
          fmt::format("byte {}: {} claims {} x {} {}, more than the {} bytes left", offset,
                      header->name, header->rows, header->columns, header->class_name, left)};
    add(*header, {begin, *wanted, false}, catalogue);
    offset = begin + *wanted;
  }
  return catalogue;
}

}  // namespace proofmass::io::matlab
