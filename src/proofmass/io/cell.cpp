#include "proofmass/io/cell.hpp"

#include <algorithm>
#include <array>
#include <fast_float/fast_float.h>
#include <limits>
#include <string>

#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

bool same_word(std::string_view text, std::string_view lower) {
  return std::ranges::equal(text, lower, [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + 32) : a) == b;
  });
}

bool is_word_for_nothing(std::string_view text) {
  constexpr std::array<std::string_view, 14> words{"nan", "-nan",    "+nan",    "null", "none",
                                                   "na",  "n/a",     "#n/a",    "#na",  "-",
                                                   "--",  "1.#qnan", "-1.#ind", "nil"};
  return std::ranges::any_of(words, [&](std::string_view word) { return same_word(text, word); });
}

/// Longer than any number a program prints: a longer field is text.
constexpr std::size_t longest_number = 800;

Cell read_figure(std::string_view digits, bool negative, char point) {
  constexpr Cell text{CellKind::text, nan};
  if (digits.empty() || (!is_digit(digits[0]) && digits[0] != point)) return text;
  if (digits.size() > longest_number) return text;
  std::array<char, longest_number> buffer;
  const auto* last = std::ranges::replace_copy(digits, buffer.begin(), point, '.').out;
  if (point != '.' && digits.find('.') != std::string_view::npos) return text;
  double value = 0.0;
  const auto end = fast_float::from_chars(buffer.data(), last, value);
  if (end.ptr != last) return text;
  return {CellKind::number, negative ? -value : value};
}

/// Number of digits at the beginning of a text.
std::size_t digits_at(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
}

/// The group separator at the beginning of a text; empty if there is none.
std::string_view grouping_mark(std::string_view text, char point) {
  // An apostrophe, straight or typographic; an underscore; blanks: usual, no-break, narrow, thin.
  constexpr std::array<std::string_view, 9> marks{
      ",", ".", "'", "\xE2\x80\x99", "_", " ", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89"};
  for (const std::string_view mark : marks)
    if (text.starts_with(mark) && mark[0] != point) return text.substr(0, mark.size());
  return {};
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks{" \t\r\0", 4};
  const auto strip = [&] {
    const auto first = text.find_first_not_of(blanks);
    text = first == std::string_view::npos
               ? std::string_view{}
               : text.substr(first, text.find_last_not_of(blanks) - first + 1);
  };
  strip();
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                      text.back() == text.front();
  if (quoted) {
    text = text.substr(1, text.size() - 2);
    strip();
  }
  return text;
}

bool is_formula(std::string_view text) {
  return !text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos;
}

std::string_view without_guard(std::string_view text) {
  return text.starts_with('\'') && is_formula(text.substr(1)) ? text.substr(1) : text;
}

Cell read_cell(std::string_view field, char point, bool is_grouped) {
  std::string_view text = trimmed(field);
  if (text.empty() || is_word_for_nothing(text)) return {CellKind::missing, nan};
  const bool negative = text[0] == '-';
  if (text[0] == '-' || text[0] == '+') text.remove_prefix(1);
  if (same_word(text, "inf") || same_word(text, "infinity") || same_word(text, "1.#inf") ||
      text == "∞")
    return {CellKind::number, negative ? -infinity : infinity};
  const Cell cell = read_figure(text, negative, point);
  if (!is_grouped || cell.kind != CellKind::text) return cell;
  const std::string plain = without_grouping(field, point);
  return plain.empty() ? cell : read_cell(plain, point);
}

std::string without_grouping(std::string_view field, char point) {
  std::string_view text = trimmed(field);
  std::string plain;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    plain += text[0];
    text.remove_prefix(1);
  }
  const std::string_view lead = text.substr(0, digits_at(text));
  if (lead.empty() || lead.size() > 3 || lead[0] == '0') return {};
  plain += lead;
  text.remove_prefix(lead.size());
  const std::string_view mark = grouping_mark(text, point);
  if (mark.empty()) return {};
  while (text.starts_with(mark)) {
    text.remove_prefix(mark.size());
    if (digits_at(text) != 3) return {};
    plain += text.substr(0, 3);
    text.remove_prefix(3);
  }
  if (!text.empty() && text[0] != point) return {};
  plain += text;
  return read_cell(plain, point).kind == CellKind::number ? plain : std::string{};
}

double to_double(const Decimal& decimal) {
  double value = 0.0;
  if (to_double_exactly(decimal, value)) return value;
  const auto binary = fast_float::compute_float<fast_float::binary_format<double>>(
      decimal.exponent10, decimal.mantissa);
  if (binary.power2 >= 0) {
    fast_float::to_float(decimal.negative, binary, value);
    return value;
  }
  // compute_float could not decide which neighbour is nearer: very rare.
  const std::string text =
      std::to_string(decimal.mantissa) + "e" + std::to_string(decimal.exponent10);
  fast_float::from_chars(text.data(), text.data() + text.size(), value);
  return decimal.negative ? -value : value;
}

}  // namespace proofmass::io
