#include "proofmass/io/numpy/npy_layout.hpp"

#include <fmt/format.h>

#include "proofmass/io/csv/layout.hpp"

namespace proofmass::io {
namespace {

Error too_large() {
  return {Errc::corrupt, "the .npy header claims more than any file can hold"};
}

Status add_fields(const NpyHeader& header, NpyLayout& layout) {
  for (const NpyField& field : header.fields) {
    if (field.count > most_columns || layout.columns.size() + field.count > most_columns)
      return Error{Errc::corrupt, "the .npy header claims too many columns"};
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string name = field.count == 1 ? field.name : fmt::format("{} {}", field.name, i);
      if (field.type.kind != 0) layout.columns.push_back({field.type, layout.row_bytes, name});
      layout.row_bytes += field.type.bytes;
    }
  }
  return Done{};
}

Status add_columns(const NpyHeader& header, std::size_t width, NpyLayout& layout) {
  if (width > most_columns)
    return Error{Errc::corrupt,
                 fmt::format("the .npy header claims {} columns: too many for a recording", width)};
  const FigureType type = header.fields[0].type;
  for (std::size_t c = 0; c < width; ++c) layout.columns.push_back({type, c * type.bytes, ""});
  layout.row_bytes = width * type.bytes;
  return Done{};
}

}  // namespace

Result<NpyPreface> peek_npy_preface(PeekSource& source) {
  auto start = source.peek(12);
  if (!start) return start.error();
  const int major = start->size() < 8 ? 0 : (*start)[6];
  if (major < 1 || major > 3)
    return Error{Errc::corrupt, "byte 6: not a version of .npy that is known (1 to 3)"};
  const std::size_t length_bytes = major == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = std::min(length_bytes, start->size() - 8); i-- > 0;)
    length = length * 256 + static_cast<unsigned char>((*start)[8 + i]);
  constexpr std::size_t longest = std::size_t{1} << 20;
  if (start->size() < 8 + length_bytes || length > longest)
    return Error{Errc::corrupt, "byte 8: the .npy header's length is impossible"};
  const std::size_t bytes = 8 + length_bytes + length;
  const Error cut{Errc::corrupt, "breaks off within the .npy header"};
  if (source.size() && *source.size() < bytes) return cut;
  const auto whole = source.peek(bytes);
  if (!whole) return whole.error();
  if (whole->size() < bytes) return cut;
  auto header = read_npy_header(whole->substr(8 + length_bytes));
  if (!header) return header.error();
  return NpyPreface{std::move(header).value(), bytes};
}

Result<NpyLayout> npy_layout(const NpyPreface& preface, bool is_turned) {
  const NpyHeader& header = preface.header;
  NpyLayout layout;
  layout.begin = preface.bytes;
  layout.is_structured = header.is_structured;
  std::size_t figures = 1;
  for (const std::size_t length : header.shape)
    if (__builtin_mul_overflow(figures, length, &figures)) return too_large();
  if (figures == 0) return Error{Errc::too_few_samples, "holds an empty array"};
  if (header.is_structured) {
    layout.rows = figures;
    if (const Status added = add_fields(header, layout); !added) return added.error();
  } else {
    if (!header.shape.empty())
      layout.rows = is_turned ? header.shape.back() : header.shape.front();
    else
      layout.rows = 1;
    layout.is_turned = is_turned;
    const std::size_t width = figures / layout.rows;
    layout.by_column = header.fortran_order != is_turned && width > 1;
    if (const Status added = add_columns(header, width, layout); !added) return added.error();
  }
  if (layout.columns.empty() || layout.row_bytes == 0)
    return Error{Errc::too_few_samples, "holds no figures"};
  std::uint64_t bytes = 0;
  if (__builtin_mul_overflow(std::uint64_t{layout.rows}, std::uint64_t{layout.row_bytes}, &bytes) ||
      bytes > (std::uint64_t{1} << 62))
    return too_large();
  return layout;
}

}  // namespace proofmass::io
