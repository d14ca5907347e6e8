#include "proofmass/io/parquet/table.hpp"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::parquet {
namespace {

constexpr std::string_view parquet_magic = "PAR1";

// Constants of parquet.thrift.
constexpr std::int64_t type_double = 5, type_byte_array = 6;
constexpr std::int64_t optional_field = 1, converted_utf8 = 0;
constexpr std::int64_t encoding_plain = 0, encoding_rle = 3, codec_none = 0, page_data = 0;

template <class Number>
void append_little_endian(std::string& out, Number number) {
  for (std::size_t k = 0; k < sizeof number; ++k)
    out += static_cast<char>(static_cast<unsigned char>(number >> (8 * k)));
}

void append_varint(std::string& out, std::uint64_t number) {
  for (; number >= 0x80U; number >>= 7U) out += static_cast<char>((number & 0x7FU) | 0x80U);
  out += static_cast<char>(number);
}

/// A struct in Thrift's compact protocol: fields in rising order of their numbers.
class ThriftStruct {
 public:
  void whole(int field, std::int64_t number, bool is_wide) {
    begin(field, is_wide ? 6 : 5);
    append_varint(bytes_, zigzag(number));
  }
  void text(int field, std::string_view text) {
    begin(field, binary);
    append_varint(bytes_, text.size());
    bytes_ += text;
  }
  void structure(int field, const std::string& finished) {
    begin(field, structured);
    bytes_ += finished;
  }
  void structures(int field, const std::vector<std::string>& finished) {
    list(field, finished.size(), structured);
    for (const std::string& one : finished) bytes_ += one;
  }
  void wholes(int field, const std::vector<std::int64_t>& numbers) {
    list(field, numbers.size(), 5);
    for (const std::int64_t number : numbers) append_varint(bytes_, zigzag(number));
  }
  void texts(int field, const std::vector<std::string>& texts) {
    list(field, texts.size(), binary);
    for (const std::string& text : texts) {
      append_varint(bytes_, text.size());
      bytes_ += text;
    }
  }
  [[nodiscard]] std::string finish() const { return bytes_ + '\0'; }

 private:
  static constexpr int binary = 8, listed = 9, structured = 12;

  static std::uint64_t zigzag(std::int64_t number) {
    return (static_cast<std::uint64_t>(number) << 1U) ^ static_cast<std::uint64_t>(number >> 63);
  }
  void begin(int field, int type) {
    PM_EXPECTS(field > last_ && field - last_ < 16);
    bytes_ += static_cast<char>(((field - last_) << 4) | type);
    last_ = field;
  }
  void list(int field, std::size_t count, int type) {
    begin(field, listed);
    if (count < 15) {
      bytes_ += static_cast<char>((count << 4U) | static_cast<unsigned>(type));
    } else {
      bytes_ += static_cast<char>(0xF0U | static_cast<unsigned>(type));
      append_varint(bytes_, count);
    }
  }

  std::string bytes_;
  int last_ = 0;
};

bool is_present(const TableCell& cell, const TableColumn& column) {
  if (const auto* figure = std::get_if<double>(&cell)) return std::isfinite(*figure);
  return column.is_text && std::holds_alternative<std::string>(cell);
}

void append_text(std::string& out, std::string_view text) {
  append_little_endian(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

// Definition levels of one bit as one bit-packed run, then the values that are present.
std::string page_of(const std::vector<TableCell>& cells, const TableColumn& column) {
  const std::size_t groups = (cells.size() + 7) / 8;
  std::string levels;
  append_varint(levels, (groups << 1U) | 1U);
  const std::size_t bits = levels.size();
  levels.resize(bits + groups, '\0');
  std::string values;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (!is_present(cells[k], column)) continue;
    levels[bits + k / 8] =
        static_cast<char>(static_cast<unsigned char>(levels[bits + k / 8]) | (1U << (k % 8)));
    const auto* figure = std::get_if<double>(&cells[k]);
    if (!column.is_text)
      append_little_endian(values, std::bit_cast<std::uint64_t>(*figure));
    else
      append_text(values,
                  figure != nullptr ? fmt::format("{}", *figure) : std::get<std::string>(cells[k]));
  }
  std::string page;
  append_little_endian(page, static_cast<std::uint32_t>(levels.size()));
  return page + levels + values;
}

std::string page_header(std::size_t bytes, std::size_t rows) {
  ThriftStruct data;
  data.whole(1, static_cast<std::int64_t>(rows), false);
  data.whole(2, encoding_plain, false);
  data.whole(3, encoding_rle, false);
  data.whole(4, encoding_rle, false);
  ThriftStruct header;
  header.whole(1, page_data, false);
  header.whole(2, static_cast<std::int64_t>(bytes), false);
  header.whole(3, static_cast<std::int64_t>(bytes), false);
  header.structure(5, data.finish());
  return header.finish();
}

std::vector<std::string> schema_of(const std::vector<TableColumn>& columns) {
  ThriftStruct root;
  root.text(4, "schema");
  root.whole(5, static_cast<std::int64_t>(columns.size()), false);
  std::vector<std::string> elements{root.finish()};
  for (const TableColumn& column : columns) {
    ThriftStruct element;
    element.whole(1, column.is_text ? type_byte_array : type_double, false);
    element.whole(3, optional_field, false);
    element.text(4, column.name);
    if (column.is_text) element.whole(6, converted_utf8, false);
    elements.push_back(element.finish());
  }
  return elements;
}

}  // namespace

TableWriter::TableWriter(NewFile file, std::vector<TableColumn> columns)
    : file_(std::move(file)), columns_(std::move(columns)) {}

Result<TableWriter> TableWriter::create(const std::string& path, std::vector<TableColumn> columns) {
  auto file = NewFile::create(path);
  if (!file) return file.error();
  TableWriter table(std::move(file).value(), std::move(columns));
  if (const Status begun = table.append(parquet_magic); !begun) return begun.error();
  return table;
}

Status TableWriter::append(std::string_view bytes) {
  offset_ += bytes.size();
  return file_.append(bytes);
}

Status TableWriter::add(const std::vector<std::vector<TableCell>>& columns) {
  PM_EXPECTS(columns.size() == columns_.size());
  if (columns.empty() || columns.front().empty()) return Done{};
  Group group{columns.front().size(), {}};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    PM_EXPECTS(columns[k].size() == group.rows && group.rows < (std::size_t{1} << 28U));
    const std::string page = page_of(columns[k], columns_[k]);
    const std::string header = page_header(page.size(), columns[k].size());
    group.chunks.push_back({offset_, header.size() + page.size()});
    if (const Status done = append(header); !done) return done;
    if (const Status done = append(page); !done) return done;
  }
  groups_.push_back(std::move(group));
  return Done{};
}

Status TableWriter::finish() {
  std::vector<std::string> groups;
  std::int64_t rows = 0;
  for (const Group& group : groups_) {
    std::vector<std::string> chunks;
    std::int64_t bytes = 0;
    for (std::size_t k = 0; k < group.chunks.size(); ++k) {
      const auto size = static_cast<std::int64_t>(group.chunks[k].bytes);
      const auto at = static_cast<std::int64_t>(group.chunks[k].offset);
      ThriftStruct facts;
      facts.whole(1, columns_[k].is_text ? type_byte_array : type_double, false);
      facts.wholes(2, {encoding_plain, encoding_rle});
      facts.texts(3, {columns_[k].name});
      facts.whole(4, codec_none, false);
      facts.whole(5, static_cast<std::int64_t>(group.rows), true);
      facts.whole(6, size, true);
      facts.whole(7, size, true);
      facts.whole(9, at, true);
      ThriftStruct chunk;
      chunk.whole(2, at, true);
      chunk.structure(3, facts.finish());
      chunks.push_back(chunk.finish());
      bytes += size;
    }
    ThriftStruct one;
    one.structures(1, chunks);
    one.whole(2, bytes, true);
    one.whole(3, static_cast<std::int64_t>(group.rows), true);
    groups.push_back(one.finish());
    rows += static_cast<std::int64_t>(group.rows);
  }
  ThriftStruct footer;
  footer.whole(1, 1, false);
  footer.structures(2, schema_of(columns_));
  footer.whole(3, rows, true);
  footer.structures(4, groups);
  footer.text(6, "proofmass");
  const std::string bytes = footer.finish();
  std::string end = bytes;
  append_little_endian(end, static_cast<std::uint32_t>(bytes.size()));
  if (const Status done = append(end + std::string(parquet_magic)); !done) return done;
  return file_.keep();
}

}  // namespace proofmass::io::parquet
