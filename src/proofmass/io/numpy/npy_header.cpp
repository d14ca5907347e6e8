#include "proofmass/io/numpy/npy_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace proofmass::io {
namespace {

/// The few forms of Python literals used in the header.
class LiteralScanner {
 public:
  explicit LiteralScanner(std::string_view text) : rest_(text) {}

  bool take(std::string_view word) {
    skip_blanks();
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  std::optional<std::string> string() {
    skip_blanks();
    if (rest_.empty() || (rest_[0] != '\'' && rest_[0] != '"')) return std::nullopt;
    const auto close = rest_.find(rest_[0], 1);
    if (close == std::string_view::npos) return std::nullopt;
    std::string out(rest_.substr(1, close - 1));
    rest_.remove_prefix(close + 1);
    return out;
  }
  std::optional<std::size_t> number() {
    skip_blanks();
    std::size_t value = 0;
    const auto end = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (end.ec != std::errc{}) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end.ptr - rest_.data()));
    take("L");  // written by Python 2
    return value;
  }
  /// "(3, 4)", "(3,)", "()", or a bare number.
  std::optional<std::vector<std::size_t>> tuple() {
    std::vector<std::size_t> out;
    if (!take("(")) {
      const auto one = number();
      if (!one) return std::nullopt;
      return std::vector{*one};
    }
    while (!take(")")) {
      const auto value = number();
      if (!value || out.size() == 32) return std::nullopt;
      out.push_back(*value);
      if (!take(",") && !(rest_.starts_with(")"))) return std::nullopt;
    }
    return out;
  }

 private:
  void skip_blanks() {
    const auto first = rest_.find_first_not_of(" \t\n\r");
    rest_.remove_prefix(first == std::string_view::npos ? rest_.size() : first);
  }
  std::string_view rest_;
};

const Error damaged{Errc::corrupt,
                    "the .npy header is damaged: expected {'descr': …, 'fortran_order': …, "
                    "'shape': …}"};

/// True if NumPy's letter and size are a supported number.
bool is_figure(char kind, std::size_t bytes) {
  const bool whole = bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
  switch (kind) {
    case 'i':
    case 'u':
      return whole;
    case 'f':
      return whole && bytes > 1;
    case 'b':
      return bytes == 1;
    default:
      return false;
  }
}

Result<FigureType> type_of(std::string_view text) {
  FigureType type;
  type.big_endian = text.starts_with('>');
  text.remove_prefix(std::min(text.find_first_not_of("<>=|"), text.size()));
  if (text.starts_with('O'))
    return Error{Errc::unsupported,
                 "holds pickled Python objects, which are not read: save plain numbers"};
  if (text.size() < 2) return damaged;
  type.kind = text[0];
  const auto end = std::from_chars(text.data() + 1, text.data() + text.size(), type.bytes);
  if (end.ec != std::errc{} || type.bytes > (1u << 16)) return damaged;
  if (is_figure(type.kind, type.bytes)) return type;
  constexpr std::string_view skipped = "USVMmc";
  if (skipped.find(type.kind) == std::string_view::npos)
    return Error{Errc::unsupported, "holds figures of type " + std::string(text) +
                                        ", which are not read: save float64"};
  if (type.kind == 'U') type.bytes *= 4;
  type.kind = 0;
  return type;
}

/// The product of the lengths; nullopt if it is zero or overflows.
std::optional<std::size_t> product(const std::vector<std::size_t>& lengths) {
  std::size_t all = 1;
  for (const std::size_t length : lengths)
    if (__builtin_mul_overflow(all, length, &all)) return std::nullopt;
  return all == 0 ? std::nullopt : std::optional(all);
}

/// ('name', '<f8') or ('name', '<f8', (3,))
Result<NpyField> read_field(LiteralScanner& scanner) {
  NpyField field;
  const bool opened = scanner.take("(");
  const auto name = scanner.string();
  const bool parted = scanner.take(",");
  const auto text = scanner.string();
  if (!opened || !name || !parted || !text) return damaged;
  const auto type = type_of(*text);
  if (!type) return type.error();
  field.name = *name;
  field.type = *type;
  if (scanner.take(",")) {
    const auto shape = scanner.tuple();
    const auto count = shape ? product(*shape) : std::nullopt;
    if (!count) return damaged;
    field.count = *count;
  }
  if (!scanner.take(")")) return damaged;
  return field;
}

Status read_fields(LiteralScanner& scanner, NpyHeader& header) {
  constexpr std::size_t most_fields = 10'000;
  while (!scanner.take("]")) {
    auto field = read_field(scanner);
    if (!field) return field.error();
    header.fields.push_back(*field);
    scanner.take(",");
    if (header.fields.size() > most_fields) return damaged;
  }
  if (header.fields.empty()) return damaged;
  return Done{};
}

Status read_description(LiteralScanner& scanner, NpyHeader& header) {
  header.fields.clear();
  header.is_structured = scanner.take("[");
  if (header.is_structured) return read_fields(scanner, header);
  const auto text = scanner.string();
  if (!text) return damaged;
  const auto type = type_of(*text);
  if (!type) return type.error();
  if (type->kind == 0)
    return Error{Errc::unsupported, "holds text or complex numbers: save plain numbers"};
  header.fields = {{"", *type, 1}};
  return Done{};
}

Status read_shape(LiteralScanner& scanner, NpyHeader& header) {
  const auto shape = scanner.tuple();
  if (!shape) return damaged;
  header.shape = *shape;
  return Done{};
}

Status read_order(LiteralScanner& scanner, NpyHeader& header) {
  header.fortran_order = scanner.take("True");
  if (!header.fortran_order && !scanner.take("False")) return damaged;
  return Done{};
}

}  // namespace

Result<NpyHeader> read_npy_header(std::string_view dictionary) {
  struct Entry {
    std::string_view key;
    Status (*read)(LiteralScanner&, NpyHeader&);
    bool seen = false;
  };
  std::array<Entry, 3> entries{
      {{"descr", read_description}, {"fortran_order", read_order}, {"shape", read_shape}}};
  LiteralScanner scanner(dictionary);
  NpyHeader header;
  if (!scanner.take("{")) return damaged;
  do {
    const auto key = scanner.string();
    if (!key) break;  // the comma after the last entry
    auto* entry = std::ranges::find(entries, *key, &Entry::key);
    if (entry == entries.end() || !scanner.take(":")) return damaged;
    if (const Status read = entry->read(scanner, header); !read) return read.error();
    entry->seen = true;
  } while (scanner.take(","));
  if (!scanner.take("}") || !std::ranges::all_of(entries, &Entry::seen)) return damaged;
  return header;
}

}  // namespace proofmass::io
