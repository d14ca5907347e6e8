#include "proofmass/io/matlab/mat5_elements.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/utf8.hpp"
#include "proofmass/io/matlab/mat_catalogue.hpp"

namespace proofmass::io::matlab {
namespace {

constexpr std::uint32_t mi_uint16 = 4;

}  // namespace

std::uint32_t word_at(const char* bytes, bool big_endian) {
  return static_cast<std::uint32_t>(load_figure(bytes, {'u', 4, big_endian}));
}

std::optional<FigureType> figure_type(std::uint32_t type, bool big_endian) {
  switch (type) {
    case 1:
      return FigureType{'i', 1, big_endian};
    case 2:
      return FigureType{'u', 1, big_endian};
    case 3:
      return FigureType{'i', 2, big_endian};
    case 4:
      return FigureType{'u', 2, big_endian};
    case 5:
      return FigureType{'i', 4, big_endian};
    case 6:
      return FigureType{'u', 4, big_endian};
    case 7:
      return FigureType{'f', 4, big_endian};
    case 9:
      return FigureType{'f', 8, big_endian};
    case 12:
      return FigureType{'i', 8, big_endian};
    case 13:
      return FigureType{'u', 8, big_endian};
    default:
      return std::nullopt;
  }
}

Result<Tag> Mat5Elements::tag(std::uint64_t end) {
  Tag tag;
  tag.at = stream_.position();
  if (end - tag.at < tag_bytes) return stream_.corrupt(tag.at, "the variable breaks off");
  std::array<char, tag_bytes> bytes{};
  if (const Status read = stream_.read(bytes); !read) return read.error();
  const std::uint32_t first = word_at(bytes.data(), big_endian_);
  tag.is_small = first >> 16 != 0;
  tag.type = tag.is_small ? first & 0xFFFF : first;
  tag.size = tag.is_small ? first >> 16 : word_at(bytes.data() + 4, big_endian_);
  tag.begin = tag.at + (tag.is_small ? 4 : tag_bytes);
  std::ranges::copy_n(bytes.begin() + 4, 4, tag.data.begin());
  const std::uint64_t room = tag.is_small ? 4 : end - tag.begin;
  if (tag.size > room)
    return stream_.corrupt(tag.at,
                           fmt::format("an element claims {} bytes, {} are there", tag.size, room));
  return tag;
}

Status Mat5Elements::skip_padding(const Tag& tag, std::uint64_t end) {
  if (tag.is_small) return Done{};
  const std::uint64_t padding = (tag_bytes - tag.size % tag_bytes) % tag_bytes;
  return stream_.skip(std::min(padding, end - stream_.position()));
}

Result<std::string> Mat5Elements::data(const Tag& tag, std::uint64_t end, std::size_t most) {
  if (tag.size > most)
    return stream_.corrupt(
        tag.at, fmt::format("an element of {} bytes where {} are the most", tag.size, most));
  if (tag.is_small) return std::string(tag.data.data(), tag.size);
  std::string bytes(tag.size, '\0');
  if (const Status read = stream_.read(bytes); !read) return read.error();
  if (const Status padding = skip_padding(tag, end); !padding) return padding.error();
  return bytes;
}

Result<std::string> Mat5Elements::words(std::uint64_t end, std::size_t most) {
  const auto next = tag(end);
  if (!next) return next.error();
  const auto type = figure_type(next->type, big_endian_);
  if (!type || type->kind == 'f' || type->bytes != 4)
    return stream_.corrupt(
        next->at, fmt::format("an element of type {} where a whole number belongs", next->type));
  return data(*next, end, most);
}

Result<std::string> Mat5Elements::characters(std::uint64_t end, std::size_t most) {
  const auto next = tag(end);
  if (!next) return next.error();
  constexpr std::uint32_t utf8 = 16;
  const auto type = figure_type(next->type, big_endian_);
  if (next->type != utf8 && (!type || type->bytes != 1))
    return stream_.corrupt(next->at,
                           fmt::format("an element of type {} where a name belongs", next->type));
  return data(*next, end, most);
}

Status Mat5Elements::read_class(Preface& preface, std::uint64_t end) {
  const std::uint64_t at = stream_.position();
  const auto flags = words(end, 8);
  if (!flags) return flags.error();
  if (flags->size() < 8) return stream_.corrupt(at, "an array without its class");
  const std::uint32_t first = word_at(flags->data(), big_endian_);
  const std::uint32_t array_class = first & 0xFF;
  if (array_class == 0 || array_class > static_cast<unsigned>(Class::opaque))
    return stream_.corrupt(at, fmt::format("an array of class {}", array_class));
  preface.array_class = static_cast<Class>(array_class);
  preface.is_complex = (first & 0x800) != 0;
  preface.is_logical = (first & 0x200) != 0;
  return Done{};
}

Status Mat5Elements::read_shape(Preface& preface, std::uint64_t end) {
  constexpr std::size_t most_dimensions = 32;
  const std::uint64_t at = stream_.position();
  const auto lengths = words(end, 4 * most_dimensions);
  if (!lengths) return lengths.error();
  for (std::size_t i = 0; i + 4 <= lengths->size(); i += 4) {
    const std::size_t length = word_at(lengths->data() + i, big_endian_);
    preface.shape.push_back(length);
    if (length > 0x7FFFFFFF || __builtin_mul_overflow(preface.count, length, &preface.count))
      return stream_.corrupt(at, "an array claims more figures than any file can hold");
  }
  if (preface.shape.size() < 2) return stream_.corrupt(at, "an array of less than 2 dimensions");
  return Done{};
}

Result<Preface> Mat5Elements::preface(std::uint64_t end) {
  constexpr std::size_t longest_name = 4096;
  Preface preface;
  if (const Status read = read_class(preface, end); !read) return read.error();
  if (preface.array_class != Class::opaque)
    if (const Status read = read_shape(preface, end); !read) return read.error();
  const auto name = characters(end, longest_name);
  if (!name) return name.error();
  preface.name = name_from(*name);
  return preface;
}

Result<std::vector<std::string>> Mat5Elements::field_names(std::uint64_t end) {
  constexpr std::size_t longest_names = std::size_t{1} << 20;
  const std::uint64_t at = stream_.position();
  const auto length = words(end, 4);
  if (!length) return length.error();
  const auto names = characters(end, longest_names);
  if (!names) return names.error();
  const std::size_t each = length->size() < 4 ? 0 : word_at(length->data(), big_endian_);
  if (each == 0 && !names->empty()) return stream_.corrupt(at, "fields with names of no length");
  std::vector<std::string> fields;
  for (std::size_t i = 0; each > 0 && i + each <= names->size(); i += each)
    fields.push_back(name_from(std::string_view(*names).substr(i, each)));
  return fields;
}

Result<std::string> Mat5Elements::text(std::uint64_t end, std::size_t most) {
  const auto next = tag(end);
  if (!next) return next.error();
  constexpr std::uint32_t utf8 = 16;
  constexpr std::uint32_t utf16 = 17;
  const auto type = figure_type(next->type == utf16 ? mi_uint16 : next->type, big_endian_);
  const bool is_wide = type && type->kind == 'u' && type->bytes == 2;
  if (next->type != utf8 && !is_wide && (!type || type->bytes != 1))
    return stream_.corrupt(next->at,
                           fmt::format("an element of type {} where a text belongs", next->type));
  auto bytes = data(*next, end, most);
  if (!bytes || next->type == utf8) return bytes;
  std::string characters;
  const std::size_t step = is_wide ? 2 : 1;
  for (std::size_t i = 0; i + step <= bytes->size(); i += step) {
    const FigureType unit{'u', step, big_endian_};
    append_utf8(characters, static_cast<std::uint32_t>(load_figure(bytes->data() + i, unit)));
  }
  return characters;
}

}  // namespace proofmass::io::matlab
