#include "proofmass/io/stamp_reader.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fast_float/fast_float.h>
#include <limits>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"

namespace proofmass::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t ns_per_day = 86'400'000'000'000;

struct WideDecimal {
  Int128 mantissa = 0;
  int exponent10 = 0;
};

/// "e-9" after a mantissa; 0 if there is nothing.
std::optional<int> scan_power(std::string_view text) {
  if (text.empty()) return 0;
  if ((text[0] | 0x20) != 'e') return std::nullopt;
  text.remove_prefix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  int power = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), power);
  const bool whole = end.ec == std::errc{} && end.ptr == text.data() + text.size();
  return whole && std::abs(power) < 10'000 ? std::optional(power) : std::nullopt;
}

/// A plain decimal of up to 37 digits, the capacity of 128 bits.
std::optional<WideDecimal> scan_wide(std::string_view text, char point) {
  WideDecimal out;
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const std::size_t size = std::min(text.find_first_of("eE"), text.size());
  int significant = 0;
  int points = 0;
  for (const char c : text.substr(0, size)) {
    if (c == point && ++points == 1) continue;
    if (!is_digit(c)) return std::nullopt;
    out.mantissa = out.mantissa * 10 + (c - '0');
    out.exponent10 -= points;
    if (out.mantissa != 0 && ++significant > 37) return std::nullopt;
  }
  const auto power = scan_power(text.substr(size));
  if (static_cast<int>(size) == points || !power) return std::nullopt;
  if (negative) out.mantissa = -out.mantissa;
  out.exponent10 += *power;
  return out;
}

/// mantissa · 10^power, nullopt if it does not fit.
std::optional<Int128> scaled(Int128 mantissa, int power) {
  if (mantissa == 0) return Int128{0};
  if (power > 38) return std::nullopt;
  for (; power > 0; --power)
    if (__builtin_mul_overflow(mantissa, Int128{10}, &mantissa)) return std::nullopt;
  return mantissa;
}

double nearest_double(Int128 mantissa, int exponent10) {
  const bool negative = mantissa < 0;
  std::array<char, 64> text;
  char* first = text.data() + 48;
  char* last = first;
  *last++ = 'e';
  std::array<char, 8> power{};
  int size = exponent10 < 0 ? -exponent10 : exponent10;
  std::size_t digits = 0;
  do {
    power[digits++] = static_cast<char>('0' + size % 10);
    size /= 10;
  } while (size != 0 && digits < power.size());
  if (exponent10 < 0) *last++ = '-';
  while (digits > 0) *last++ = power[--digits];
  do {
    const int digit = static_cast<int>(mantissa % 10);
    *--first = static_cast<char>('0' + (digit < 0 ? -digit : digit));
    mantissa /= 10;
  } while (mantissa != 0);
  double value = 0.0;
  fast_float::from_chars(first, last, value);
  return negative ? -value : value;
}

}  // namespace

double StampOrigin::value() const {
  return nearest_double(mantissa, exponent10);
}

std::optional<std::int64_t> StampOrigin::ns(double unit_s) const {
  const double power = std::log10(unit_s);
  const double whole_power = std::round(power);
  Int128 exact = mantissa;
  int exponent = exponent10 + 9;
  if (std::abs(power - whole_power) < 1e-9) {
    exponent += static_cast<int>(whole_power);
  } else if (std::abs(unit_s - std::round(unit_s)) < 1e-9 && unit_s < 1e6) {
    if (__builtin_mul_overflow(exact, Int128{std::llround(unit_s)}, &exact)) return std::nullopt;
  }
  for (; exponent < -1 && exact != 0; ++exponent) exact /= 10;
  if (exponent == -1) {
    exact = (exact + (exact < 0 ? -5 : 5)) / 10;
    exponent = 0;
  }
  const auto in_ns = scaled(exact, exact == 0 ? 0 : exponent);
  constexpr Int128 limit = std::numeric_limits<std::int64_t>::max();
  if (!in_ns || *in_ns > limit || *in_ns < -limit) return std::nullopt;
  return static_cast<std::int64_t>(*in_ns);
}

void StampReader::set_origin(const StampOrigin& origin) {
  origin_ = origin;
  if (origin.mantissa > narrow_limit || origin.mantissa < -narrow_limit) return;
  narrow_mantissa_ = static_cast<std::int64_t>(origin.mantissa);
  narrow_exponent10_ = origin.exponent10;
}

double StampReader::difference(Int128 mantissa, int exponent10) {
  if (!origin_) set_origin({mantissa, exponent10});
  const int common = std::min(exponent10, origin_->exponent10);
  const auto stamp = scaled(mantissa, exponent10 - common);
  const auto first = scaled(origin_->mantissa, origin_->exponent10 - common);
  Int128 exact = 0;
  if (!stamp || !first || __builtin_sub_overflow(*stamp, *first, &exact))
    return nearest_double(mantissa, exponent10) - origin_->value();
  return nearest_double(exact, common);
}

double StampReader::read_clock_fields(std::string_view field, std::string_view date) {
  const auto clock = read_clock(field);
  if (!clock || !clock->ns) return nan;
  zone_missing_ = zone_missing_ || !clock->zone_given;
  std::int64_t days = 0;
  if (spelling_ == StampSpelling::date_then_clock) {
    const auto day = read_clock(date);
    if (!day || !day->days) return nan;
    days = *day->days;
  } else if (clock->days) {
    days = *clock->days;
  } else {
    // Half a day back is midnight; less is a clock that was set.
    if (*clock->ns < last_of_day_ - ns_per_day / 2) ++day_;
    last_of_day_ = *clock->ns;
    days = day_;
  }
  return difference(Int128{days} * ns_per_day + *clock->ns, -9);
}

double StampReader::read(std::string_view field, std::string_view date) {
  if (spelling_ != StampSpelling::figures) return read_clock_fields(field, date);
  const std::string_view text = trimmed(field);
  const auto stamp = scan_wide(text, point_);
  if (!stamp) return nan;
  // No clock has a value of this size; as the first stamp it would spoil the rest.
  if (std::abs(nearest_double(stamp->mantissa, stamp->exponent10)) > 1e20) return nan;
  return difference(stamp->mantissa, stamp->exponent10);
}

}  // namespace proofmass::io
