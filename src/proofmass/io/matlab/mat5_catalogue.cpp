#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <optional>

#include "proofmass/io/matlab/mat5_elements.hpp"
#include "proofmass/io/matlab/mat_catalogue.hpp"

namespace proofmass::io::matlab {
namespace {

constexpr std::size_t header_bytes = 128;
constexpr std::size_t deepest = 16;

std::string_view name_of(Class array_class) {
  constexpr std::array names = std::to_array<std::string_view>(
      {"", "cell", "struct", "object", "text", "sparse", "double", "single", "int8", "uint8",
       "int16", "uint16", "int32", "uint32", "int64", "uint64", "function handle", "object"});
  return names[static_cast<std::size_t>(array_class)];
}

/// Scans one variable and lists its numeric arrays.
class Walker {
 public:
  Walker(Stream& stream, const Region& region, bool big_endian, Catalogue& catalogue)
      : stream_(stream),
        region_(region),
        big_endian_(big_endian),
        catalogue_(catalogue),
        elements_(stream, big_endian) {}

  Status run() {
    if (!region_.is_packed) return array(Place{}, region_.size);
    const auto outer = elements_.tag(stream_.most());
    if (!outer) return outer.error();
    if (outer->type != mi_matrix || outer->is_small)
      return stream_.corrupt(0, "what is compressed here is not a variable");
    if (const Status read = array(Place{}, outer->begin + outer->size); !read) return read;
    return stream_.finish();
  }

 private:
  /// Position of an array in the tree of structs and cells.
  struct Place {
    std::string path;
    std::size_t group_length = 0;
    std::size_t depth = 0;
  };

  /// Reads an array that ends at `end`; a variable has its own name.
  Status array(Place place, std::uint64_t end) {
    const auto preface = elements_.preface(end);
    if (!preface) return preface.error();
    const bool is_variable = place.depth == 0;
    if (is_variable) place.path = preface->name;
    // MATLAB stores the workspaces of function handles in an unnamed variable.
    const bool is_private = is_variable && place.path.empty();
    if (!is_private && !is_full())
      if (const Status read = content(place, *preface, end); !read) return read;
    return stream_.skip(end - stream_.position());
  }

  Status content(const Place& place, const Preface& preface, std::uint64_t end) {
    const Class array_class = preface.array_class;
    const bool is_nest = array_class == Class::cell || array_class == Class::structure;
    if (is_nest && place.depth >= deepest) return leave_out(place, "nested too deeply");
    if (array_class == Class::cell) return cell(place, preface, end);
    if (array_class == Class::structure) return structure(place, preface, end);
    if (array_class == Class::text && is_about_others(place)) return text(place, preface, end);
    if (array_class < Class::double_precision || array_class > Class::uint64)
      return leave_out(place, name_of(array_class));
    if (preface.count == 0) return leave_out(place, "empty");
    return numbers(place, preface, end);
  }

  Status numbers(const Place& place, const Preface& preface, std::uint64_t end) {
    const auto figures = elements_.tag(end);
    if (!figures) return figures.error();
    const auto type = figure_type(figures->type, big_endian_);
    if (!type)
      return stream_.corrupt(figures->at,
                             fmt::format("an element of type {} where the figures of {} belong",
                                         figures->type, place.path));
    Array array;
    array.path = place.path;
    array.group_length = place.group_length;
    array.class_name =
        preface.is_logical ? std::string_view("logical") : name_of(preface.array_class);
    array.shape = preface.shape;
    array.is_complex = preface.is_complex;
    array.region = region_;
    array.begin = figures->begin;
    array.stored = *type;
    if (figures->size % type->bytes != 0 || figures->size / type->bytes != preface.count)
      return stream_.corrupt(figures->at, fmt::format("{} claims {}, and has {} bytes", place.path,
                                                      array.description(), figures->size));
    catalogue_.arrays.push_back(std::move(array));
    return Done{};
  }

  static bool is_about_others(const Place& place) {
    const std::string_view group = std::string_view(place.path).substr(0, place.group_length);
    return group == "names" || group == "units";
  }

  Status text(const Place& place, const Preface& preface, std::uint64_t end) {
    constexpr std::size_t most_bytes = 512;
    if (preface.count == 0) return Done{};
    if (preface.count > most_bytes / 2) return leave_out(place, "text");
    auto read = elements_.text(end, most_bytes);
    if (!read) return read.error();
    catalogue_.texts.push_back({place.path, std::move(read).value()});
    return Done{};
  }

  Status cell(const Place& place, const Preface& preface, std::uint64_t end) {
    if (const Status fits = check_room(place, preface.count, end); !fits) return fits;
    for (std::size_t i = 0; i < preface.count && !is_full(); ++i) {
      const Place at{fmt::format("{}{{{}}}", place.path, i + 1), place.path.size(),
                     place.depth + 1};
      if (const Status read = member(at, end); !read) return read;
    }
    return Done{};
  }

  Status structure(const Place& place, const Preface& preface, std::uint64_t end) {
    const auto fields = elements_.field_names(end);
    if (!fields) return fields.error();
    std::size_t members = 0;
    if (__builtin_mul_overflow(preface.count, fields->size(), &members))
      members = std::numeric_limits<std::size_t>::max();
    if (const Status fits = check_room(place, members, end); !fits) return fits;
    for (std::size_t i = 0; i < members && !is_full(); ++i) {
      const std::string group = preface.count == 1
                                    ? place.path
                                    : fmt::format("{}({})", place.path, i / fields->size() + 1);
      const std::string& field = (*fields)[i % fields->size()];
      const Place at{group + "." + field, group.size(), place.depth + 1};
      if (const Status read = member(at, end); !read) return read;
    }
    return Done{};
  }

  Status member(const Place& place, std::uint64_t end) {
    const auto next = elements_.tag(end);
    if (!next) return next.error();
    if (next->type != mi_matrix)
      return stream_.corrupt(
          next->at, fmt::format("an element of type {} where {} belongs", next->type, place.path));
    if (next->is_small || next->size == 0) return Done{};
    if (const Status read = array(place, next->begin + next->size); !read) return read;
    return elements_.skip_padding(*next, end);
  }

  /// Each member has at least a tag.
  [[nodiscard]] Status check_room(const Place& place,
                                  std::size_t members,
                                  std::uint64_t end) const {
    const std::uint64_t left = end - stream_.position();
    if (members <= left / tag_bytes) return Done{};
    return stream_.corrupt(stream_.position(),
                           fmt::format("{} claims {} members, more than the {} bytes left",
                                       place.path, members, left));
  }

  Status leave_out(const Place& place, std::string_view what) {
    catalogue_.skipped.push_back(fmt::format("{} ({})", place.path, what));
    return Done{};
  }

  bool is_full() {
    if (catalogue_.arrays.size() + catalogue_.skipped.size() >= most_arrays ||
        catalogue_.texts.size() >= 4 * most_arrays)
      catalogue_.is_cut = true;
    return catalogue_.is_cut;
  }

  Stream& stream_;
  const Region& region_;
  bool big_endian_;
  Catalogue& catalogue_;
  Mat5Elements elements_;
};

/// The byte order given in the header; nullopt if it is not of this version.
std::optional<bool> is_big_endian(std::string_view file) {
  if (file.size() < header_bytes) return std::nullopt;
  const std::string_view mark = file.substr(124, 4);
  if (mark == std::string_view("\0\1IM", 4)) return false;
  if (mark == std::string_view("\1\0MI", 4)) return true;
  return std::nullopt;
}

bool is_padding(std::string_view bytes) {
  return std::ranges::all_of(bytes, [](char c) { return c == '\0'; });
}

/// The variable that begins at `offset`.
Result<Region> region_at(std::string_view file, std::size_t offset, bool big_endian) {
  const std::size_t left = file.size() - offset;
  if (left < tag_bytes)
    return Error{Errc::corrupt,
                 fmt::format("byte {}: breaks off where a variable begins", file.size())};
  const std::uint32_t type = word_at(file.data() + offset, big_endian);
  const std::size_t size = word_at(file.data() + offset + 4, big_endian);
  if (type != mi_matrix && type != mi_compressed)
    return Error{Errc::corrupt, fmt::format("byte {}: no variable begins here", offset)};
  if (size > left - tag_bytes)
    return Error{Errc::corrupt,
                 fmt::format("byte {}: breaks off within the variable that begins at byte {} and "
                             "claims {} bytes",
                             file.size(), offset, size)};
  return Region{offset + tag_bytes, size, type == mi_compressed};
}

}  // namespace

bool is_mat5(std::string_view head) {
  return is_big_endian(head).has_value() || head.starts_with("MATLAB 5.0 MAT-file");
}

Result<Catalogue> list_mat5(std::string_view file) {
  const auto big_endian = is_big_endian(file);
  if (!big_endian && file.size() < header_bytes)
    return Error{Errc::corrupt, fmt::format("byte {}: breaks off within the header", file.size())};
  if (!big_endian)
    return Error{Errc::corrupt, "byte 124: neither version nor order of bytes that are known"};
  Catalogue catalogue;
  catalogue.version = "MAT v5";
  std::size_t offset = header_bytes;
  while (offset < file.size() && !is_padding(file.substr(offset))) {
    const auto region = region_at(file, offset, *big_endian);
    if (!region) return region.error();
    Stream stream(file, *region);
    const Status listed = Walker(stream, *region, *big_endian, catalogue).run();
    if (!listed) return listed.error();
    offset = region->offset + region->size;
  }
  return catalogue;
}

}  // namespace proofmass::io::matlab
