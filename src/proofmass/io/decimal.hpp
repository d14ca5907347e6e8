#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace proofmass::io {

/// A decimal number as written: ±mantissa · 10^exponent10.
struct Decimal {
  std::uint64_t mantissa = 0;
  int exponent10 = 0;
  bool negative = false;
};

/// Bytes that must be readable after any text given to scan_decimal: it reads eight at a time.
inline constexpr std::size_t decimal_padding = 8;

inline bool is_digit(char c) {
  return static_cast<unsigned char>(c - '0') < 10;
}

namespace detail {

inline std::uint64_t load_8(const char* p) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, p, sizeof bytes);
  return bytes;
}

/// The high bit of each byte that is not a digit. '0' has been subtracted from each of `bytes`: a
/// digit is 0 … 9, to which 118 can be added without reaching the high bit.
inline std::uint64_t marks_of_others(std::uint64_t bytes) {
  return ((bytes + 0x7676767676767676) | bytes) & 0x8080808080808080;
}

/// The number given by eight digits 0 … 9, first byte first, by pairwise sums in one register.
/// Source: D. Lemire, "Number parsing at a gigabyte per second", Softw. Pract. Exper. 51 (2021)
/// 1700.
inline std::uint32_t value_of_8_digits(std::uint64_t digits) {
  digits = digits * 10 + (digits >> 8);
  constexpr std::uint64_t mask = 0x000000FF000000FF;
  return static_cast<std::uint32_t>(((digits & mask) * (100 + (1000000ULL << 32)) +
                                     ((digits >> 16) & mask) * (1 + (10000ULL << 32))) >>
                                    32);
}

/// Appends the digits at p to the mantissa, eight at a time. The last few are shifted to the end of
/// the register, where missing digits count as leading zeros. No branch depends on their number,
/// which is the one unpredictable property of numbers.
inline const char* scan_digits(const char* p, std::uint64_t& mantissa) {
  if constexpr (std::endian::native == std::endian::little) {
    static constexpr std::array<std::uint64_t, 8> powers{1,      10,      100,       1'000,
                                                         10'000, 100'000, 1'000'000, 10'000'000};
    for (;;) {
      const std::uint64_t digits = load_8(p) ^ 0x3030303030303030;
      const std::uint64_t others = marks_of_others(digits);
      if (others != 0) {
        const int count = std::countr_zero(others) / 8;
        // In two steps, because a shift by all 64 bits is undefined.
        const std::uint64_t moved = (digits << 8) << (56 - 8 * count);
        mantissa = mantissa * powers[static_cast<std::size_t>(count)] + value_of_8_digits(moved);
        return p + count;
      }
      mantissa = mantissa * 100'000'000 + value_of_8_digits(digits);
      p += 8;
    }
  }
  for (; is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
  return p;
}

/// Zeros before the first other digit, not counting the point.
inline std::ptrdiff_t count_leading_zeros(const char* p, char point) {
  std::ptrdiff_t zeros = 0;
  for (; *p == '0' || *p == point; ++p)
    if (*p == '0') ++zeros;
  return zeros;
}

inline const char* scan_exponent(const char* p, int& exponent10) {
  const bool negative = *p == '-';
  if (*p == '-' || *p == '+') ++p;
  if (!is_digit(*p)) return nullptr;
  int exponent = 0;
  for (; is_digit(*p); ++p)
    if (exponent < 10'000) exponent = exponent * 10 + (*p - '0');
  exponent10 += negative ? -exponent : exponent;
  return p;
}

}  // namespace detail

/// Parses [+-]digits[point digits][e[+-]digits] and returns the end; nullptr if there is not a
/// number or one of more than 19 significant digits, whose mantissa would not fit. The text must
/// end in a non-digit followed by decimal_padding bytes.
inline const char* scan_decimal(const char* p, char point, Decimal& out) {
  // Signs are unpredictable: no branch may depend on them.
  out.negative = *p == '-';
  p += static_cast<int>(out.negative) | static_cast<int>(*p == '+');
  std::uint64_t mantissa = 0;
  const char* const first = p;
  // There are few digits before the point, usually as many as in the previous row.
  for (; is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
  std::ptrdiff_t digits = p - first;
  int exponent10 = 0;
  if (*p == point) {
    const char* const fraction = p + 1;
    p = detail::scan_digits(fraction, mantissa);
    exponent10 = static_cast<int>(fraction - p);
    digits += p - fraction;
  }
  if (digits == 0) return nullptr;
  if (digits > 19 && digits - detail::count_leading_zeros(first, point) > 19) return nullptr;
  if ((*p | 0x20) == 'e') {
    p = detail::scan_exponent(p + 1, exponent10);
    if (p == nullptr) return nullptr;
  }
  out.mantissa = mantissa;
  out.exponent10 = exponent10;
  return p;
}

/// The nearest double if one division or product of exact factors gives it, which is the case for
/// nearly all logged numbers; false otherwise.
/// Source: W. D. Clinger, "How to read floating point numbers accurately", PLDI 1990, section 3.
inline bool to_double_exactly(const Decimal& decimal, double& out) {
  static constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  if (decimal.mantissa > (std::uint64_t{1} << 53)) return false;
  const auto m = static_cast<double>(decimal.mantissa);
  const int e = decimal.exponent10;
  double size = 0.0;
  if (e <= 0 && e >= -22)
    size = m / powers[static_cast<std::size_t>(-e)];
  else if (e > 0 && e <= 22)
    size = m * powers[static_cast<std::size_t>(e)];
  else
    return false;
  out = std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) | std::uint64_t{decimal.negative}
                                                                       << 63);
  return true;
}

/// The nearest double to a decimal of any size. Source: D. Lemire (2021), as above, in the
/// fast_float library.
[[nodiscard]] double to_double(const Decimal& decimal);

}  // namespace proofmass::io
