#include "proofmass/io/npy_header.hpp"

#include <charconv>
#include <optional>

namespace proofmass::io {
namespace {

/// The few forms of Python literal that the header is made of.
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

Result<NpyType> type_of(std::string_view text) {
  NpyType type;
  if (text.starts_with('>')) type.big_endian = true;
  if (!text.empty() && std::string_view("<>=|").find(text[0]) != std::string_view::npos)
    text.remove_prefix(1);
  if (text.starts_with('O'))
    return Error{Errc::unsupported,
                 "holds pickled Python objects, which are not read: save plain numbers"};
  if (text.size() < 2) return damaged;
  type.kind = text[0];
  const auto end = std::from_chars(text.data() + 1, text.data() + text.size(), type.bytes);
  if (end.ec != std::errc{} || type.bytes > (1u << 16)) return damaged;
  const std::size_t n = type.bytes;
  const bool whole = n == 1 || n == 2 || n == 4 || n == 8;
  switch (type.kind) {
    case 'i':
    case 'u':
      if (whole) return type;
      break;
    case 'f':
      if (whole && n > 1) return type;
      break;
    case 'b':
      if (n == 1) return type;
      break;
    case 'U':
      type.bytes = 4 * n;
      [[fallthrough]];
    case 'S':
    case 'V':
    case 'M':
    case 'm':
    case 'c':
      type.kind = 0;
      return type;
    default:
      break;
  }
  return Error{Errc::unsupported,
               "holds figures of type " + std::string(text) + ", which are not read: save float64"};
}

Result<std::vector<NpyField>> fields_of(LiteralScanner& scanner) {
  std::vector<NpyField> fields;
  while (!scanner.take("]")) {
    if (fields.size() > 10'000 || !scanner.take("(")) return damaged;
    NpyField field;
    const auto name = scanner.string();
    if (!name || !scanner.take(",")) return damaged;
    const auto text = scanner.string();
    if (!text) return damaged;
    const auto type = type_of(*text);
    if (!type) return type.error();
    field.name = *name;
    field.type = *type;
    if (scanner.take(",")) {
      const auto shape = scanner.tuple();
      if (!shape) return damaged;
      for (const std::size_t length : *shape)
        if (__builtin_mul_overflow(field.count, length, &field.count)) return damaged;
    }
    if (!scanner.take(")") || field.count == 0) return damaged;
    fields.push_back(std::move(field));
    scanner.take(",");
  }
  if (fields.empty()) return damaged;
  return fields;
}

Status read_description(LiteralScanner& scanner, NpyHeader& header) {
  header.is_structured = scanner.take("[");
  if (header.is_structured) {
    auto fields = fields_of(scanner);
    if (!fields) return fields.error();
    header.fields = *fields;
    return Done{};
  }
  const auto text = scanner.string();
  if (!text) return damaged;
  const auto type = type_of(*text);
  if (!type) return type.error();
  if (type->kind == 0)
    return Error{Errc::unsupported, "holds text or complex numbers: save plain numbers"};
  header.fields = {{"", *type, 1}};
  return Done{};
}

}  // namespace

Result<NpyHeader> read_npy_header(std::string_view dictionary) {
  LiteralScanner scanner(dictionary);
  NpyHeader header;
  bool shaped = false;
  if (!scanner.take("{")) return damaged;
  while (!scanner.take("}")) {
    const auto key = scanner.string();
    if (!key || !scanner.take(":")) return damaged;
    if (*key == "descr") {
      if (const Status read = read_description(scanner, header); !read) return read.error();
    } else if (*key == "fortran_order") {
      header.fortran_order = scanner.take("True");
      if (!header.fortran_order && !scanner.take("False")) return damaged;
    } else if (*key == "shape") {
      const auto shape = scanner.tuple();
      if (!shape) return damaged;
      header.shape = *shape;
      shaped = true;
    } else {
      return damaged;
    }
    if (scanner.take("}")) break;
    if (!scanner.take(",")) return damaged;
  }
  if (!shaped || header.fields.empty()) return damaged;
  return header;
}

}  // namespace proofmass::io
