#include "proofmass/io/mcap/samples.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/io/bytes/little_endian.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/json_leaves.hpp"
#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {
namespace {

constexpr std::uint8_t version = 1;
constexpr std::uint8_t stamps_flag = 1;

template <class T>
std::optional<T> number_in(const std::map<std::string, std::string>& metadata, const char* key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) return std::nullopt;
  const char* end = found->second.data() + found->second.size();
  T value{};
  const auto read = std::from_chars(found->second.data(), end, value);
  return read.ec == std::errc{} && read.ptr == end ? std::optional(value) : std::nullopt;
}

/// "columns.12.name" is the name of column 12.
struct ColumnPath {
  std::size_t column = 0;
  std::string_view member;
};

std::optional<ColumnPath> column_path(std::string_view path) {
  constexpr std::string_view start = "columns.";
  if (!path.starts_with(start)) return std::nullopt;
  path.remove_prefix(start.size());
  ColumnPath out;
  const auto read = std::from_chars(path.data(), path.data() + path.size(), out.column);
  if (read.ec != std::errc{} || read.ptr == path.data() + path.size()) return std::nullopt;
  out.member = path.substr(static_cast<std::size_t>(read.ptr - path.data()) + 1);
  return out;
}

}  // namespace

Result<SamplesHead> read_samples_head(std::string_view message) {
  Fields fields(message);
  const std::uint8_t found_version = fields.u8();
  SamplesHead head;
  head.has_stamps = (fields.u8() & stamps_flag) != 0;
  head.columns = fields.u16();
  head.rows = fields.u32();
  head.first = fields.u64();
  if (!fields.is_whole()) return Error{Errc::corrupt, "is too short for a block of samples"};
  if (found_version != version)
    return Error{Errc::unsupported,
                 fmt::format("is of version {} of blocks of samples, expected 1", found_version)};
  const std::uint64_t row_bytes = 8 * (std::uint64_t{head.columns} + (head.has_stamps ? 1 : 0));
  if (row_bytes * head.rows != fields.left())
    return Error{Errc::corrupt, fmt::format("has {} bytes for {} rows of {} bytes", fields.left(),
                                            head.rows, row_bytes)};
  return head;
}

void write_samples(std::uint64_t first,
                   View<double> stamps_s,
                   std::span<const View<double>> columns,
                   std::string& message) {
  const std::size_t rows = columns.empty() ? 0 : columns.front().size();
  message.clear();
  append_little_endian(message, version, 1);
  append_little_endian(message, stamps_s.empty() ? 0 : stamps_flag, 1);
  append_little_endian(message, columns.size(), 2);
  append_little_endian(message, rows, 4);
  append_little_endian(message, first, 8);
  append_doubles(message, stamps_s);
  for (const View<double> column : columns) append_doubles(message, column);
}

std::string samples_schema(const SamplesLayout& layout) {
  std::string columns;
  for (const SamplesLayout::Column& column : layout.columns)
    columns += fmt::format("{}{{\"name\":{},\"unit\":{}}}", columns.empty() ? "" : ",",
                           json_text(column.name), json_text(column.unit));
  return fmt::format(
      R"({{"$schema":"https://json-schema.org/draft/2020-12/schema","title":"Block of samples",)"
      R"("description":"Binary, little-endian: u8 version 1, u8 flags (1: stamps), u16 columns, )"
      R"(u32 rows, u64 number of the first row, f64 stamps[rows] in s if flagged, then )"
      R"(f64 figures[columns][rows]","type":"object","columns":[{}]}})",
      columns);
}

std::map<std::string, std::string> samples_metadata(const SamplesLayout& layout) {
  std::map<std::string, std::string> out{{"stamps", layout.has_stamps ? "yes" : "no"}};
  if (layout.rate_hz) out["rate_hz"] = fmt::format("{}", *layout.rate_hz);
  if (layout.start_ns) out["start_ns"] = std::to_string(*layout.start_ns);
  if (!layout.derived_from.empty()) out["derived_from"] = layout.derived_from;
  return out;
}

Result<SamplesLayout> read_samples_layout(std::string_view schema,
                                          const std::map<std::string, std::string>& metadata) {
  SamplesLayout out;
  bool is_sound = true;
  const Status visited = visit_json(schema, [&](const JsonLeaf& leaf) {
    const auto place = column_path(leaf.path);
    if (!place || !leaf.text) return;
    is_sound = is_sound && place->column <= out.columns.size() && place->column < most_columns;
    if (!is_sound) return;
    if (place->column == out.columns.size()) out.columns.emplace_back();
    if (place->member == "name") out.columns[place->column].name = *leaf.text;
    if (place->member == "unit") out.columns[place->column].unit = *leaf.text;
  });
  if (!visited) return visited.error().at("its schema");
  if (!is_sound || out.columns.empty())
    return Error{Errc::corrupt, "its schema does not list the columns of its blocks of samples"};
  const auto stamps = metadata.find("stamps");
  out.has_stamps = stamps != metadata.end() && stamps->second == "yes";
  out.rate_hz = number_in<double>(metadata, "rate_hz");
  if (out.rate_hz && !(*out.rate_hz > 0.0 && *out.rate_hz < 1e12)) out.rate_hz.reset();
  out.start_ns = number_in<std::int64_t>(metadata, "start_ns");
  return out;
}

}  // namespace proofmass::io::mcap
