#include "proofmass/io/clock_text.hpp"

#include <chrono>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

/// A cursor over the text; each parser moves it only on success.
struct Scanner {
  std::string_view rest;

  bool take(char c) {
    if (rest.empty() || rest.front() != c) return false;
    rest.remove_prefix(1);
    return true;
  }
  bool take(std::string_view word) {
    if (!rest.starts_with(word)) return false;
    rest.remove_prefix(word.size());
    return true;
  }
  void skip_blanks() {
    while (take(' ')) {
    }
  }
  /// Between `fewest` and `most` digits.
  std::optional<int> digits(std::size_t fewest, std::size_t most) {
    int value = 0;
    std::size_t count = 0;
    for (; count < most && count < rest.size() && is_digit(rest[count]); ++count)
      value = value * 10 + (rest[count] - '0');
    if (count < fewest) return std::nullopt;
    rest.remove_prefix(count);
    return value;
  }
};

std::optional<std::int64_t> days_of(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count();
}

/// 2024-01-17, 2024/01/17 or 17.01.2024
std::optional<std::int64_t> read_date(Scanner& text) {
  Scanner at = text;
  const auto first = at.digits(1, 4);
  if (!first) return std::nullopt;
  const char mark = at.rest.empty() ? '\0' : at.rest.front();
  if (mark != '-' && mark != '/' && mark != '.') return std::nullopt;
  at.take(mark);
  const auto second = at.digits(1, 2);
  if (!second || !at.take(mark)) return std::nullopt;
  const auto third = at.digits(1, 4);
  if (!third) return std::nullopt;
  const bool day_first = mark == '.';
  const int year = day_first ? *third : *first;
  if (year < 1900) return std::nullopt;
  const auto days = days_of(year, *second, day_first ? *first : *third);
  if (days) text = at;
  return days;
}

constexpr std::int64_t ns_per_s = 1'000'000'000;

/// The decimals of the seconds; those beyond the ninth are ignored.
std::int64_t read_fraction_ns(Scanner& at) {
  std::int64_t ns = 0;
  std::int64_t weight = ns_per_s / 10;
  while (!at.rest.empty() && is_digit(at.rest.front())) {
    ns += weight * (at.rest.front() - '0');
    weight /= 10;
    at.rest.remove_prefix(1);
  }
  return ns;
}

/// 8:14, 08:14:46, 08:14:46.069, 08:14:46,069, 08:14:46:069
std::optional<std::int64_t> read_time_of_day(Scanner& text) {
  Scanner at = text;
  const auto hours = at.digits(1, 2);
  if (!hours || !at.take(':')) return std::nullopt;
  const auto minutes = at.digits(2, 2);
  if (!minutes) return std::nullopt;
  std::int64_t ns = (*hours * std::int64_t{3600} + *minutes * std::int64_t{60}) * ns_per_s;
  if (at.take(':')) {
    const auto seconds = at.digits(2, 2);
    if (!seconds || *seconds > 60) return std::nullopt;
    ns += *seconds * ns_per_s;
    // Some formats separate milliseconds by a colon.
    if (at.take('.') || at.take(',') || at.take(':')) ns += read_fraction_ns(at);
  }
  if (*hours > 24 || *minutes > 59) return std::nullopt;
  text = at;
  return ns;
}

/// Z, +02:00, -0530, +02; optionally preceded by "UTC" or "GMT". True if there was a zone.
bool read_zone(Scanner& text, std::int64_t& offset_ns) {
  const bool named = text.take('Z') || text.take("UTC") || text.take("GMT");
  Scanner at = text;
  const bool west = at.take('-');
  if (!west && !at.take('+')) return named;
  const auto hours = at.digits(2, 2);
  if (!hours) return named;
  at.take(':');
  const int minutes = at.digits(2, 2).value_or(0);
  offset_ns = (*hours * std::int64_t{3600} + minutes * std::int64_t{60}) * ns_per_s;
  if (west) offset_ns = -offset_ns;
  text = at;
  return true;
}

}  // namespace

std::optional<ClockReading> read_clock(std::string_view field) {
  Scanner at{trimmed(field)};
  // The longest of these forms; also keeps the arithmetic within its range.
  if (at.rest.size() < 4 || at.rest.size() > 48 || !is_digit(at.rest.front())) return std::nullopt;
  ClockReading reading;
  reading.days = read_date(at);
  if (reading.days && !at.take('T')) at.skip_blanks();
  reading.ns = read_time_of_day(at);
  if (reading.ns) {
    at.skip_blanks();
    std::int64_t offset_ns = 0;
    reading.zone_given = read_zone(at, offset_ns);
    *reading.ns -= offset_ns;
  }
  if (!at.rest.empty() || (!reading.days && !reading.ns)) return std::nullopt;
  return reading;
}

std::optional<std::int64_t> instant_ns(const ClockReading& reading) {
  if (!reading.days || !reading.ns) return std::nullopt;
  constexpr std::int64_t day_ns = 86'400'000'000'000;
  std::int64_t ns = 0;
  if (__builtin_mul_overflow(*reading.days, day_ns, &ns) ||
      __builtin_add_overflow(ns, *reading.ns, &ns))
    return std::nullopt;
  return ns;
}

}  // namespace proofmass::io
