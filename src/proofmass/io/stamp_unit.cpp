#include "proofmass/io/stamp_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

constexpr double year_2000_s = 946'684'800.0;
constexpr double year_2060_s = 2'840'140'800.0;
constexpr double day_s = 86'400.0;
constexpr std::int64_t from_1904_to_1970_s = 2'082'844'800;

bool is_of_this_age(double epoch_s) {
  return epoch_s > year_2000_s && epoch_s < year_2060_s;
}

/// The origin minus a whole number of its units; unchanged if that needs too many digits.
StampOrigin less(StampOrigin origin, std::int64_t units) {
  if (origin.exponent10 > 0 || origin.exponent10 < -18) return origin;
  Int128 shift = units;
  for (int power = origin.exponent10; power < 0; ++power) shift *= 10;
  Int128 mantissa = 0;
  if (!__builtin_sub_overflow(origin.mantissa, shift, &mantissa)) origin.mantissa = mantissa;
  return origin;
}

/// Days since some day, as in MATLAB and spreadsheets: as seconds they would be implausibly fast,
/// above 10 kHz.
std::optional<StampUnit> as_days(const StampColumn& stamps, double step) {
  struct Calendar {
    std::int64_t day_of_1970;
    std::string_view words;
  };
  constexpr std::array<Calendar, 2> calendars{
      {{719'529, "MATLAB's date numbers"}, {25'569, "dates as a spreadsheet counts them"}}};
  if (step > 1e-4 || 1.0 / (step * day_s) > 1e5) return std::nullopt;
  for (const auto& [day_of_1970, words] : calendars) {
    const double since_1970 = stamps.origin.value() - static_cast<double>(day_of_1970);
    if (!is_of_this_age(since_1970 * day_s)) continue;
    return StampUnit{day_s, less(stamps.origin, day_of_1970), true,
                     Note{Severity::info, fmt::format("{}: days, {} ({} Hz)", stamps.name, words,
                                                      in_words(1.0 / (step * day_s)))}};
  }
  return std::nullopt;
}

/// Xsens' SampleTimeFine: microseconds in the DOT, ticks of 100 µs in the MTi. Source: Xsens DOT
/// user manual, "SampleTimeFine"; MT low level communication protocol.
std::optional<StampUnit> as_xsens(const StampColumn& stamps, double step) {
  if (stamps.name != "SampleTimeFine") return std::nullopt;
  const double unit_s = step > 400.0 ? 1e-6 : 1e-4;
  return StampUnit{
      unit_s, stamps.origin, false,
      Note{Severity::info, fmt::format("{}: in steps of {} us, as Xsens units write it",
                                       stamps.name, in_words(unit_s * 1e6))}};
}

/// Selects one of s, ms, us and ns.
StampUnit guess(const StampColumn& stamps, double step) {
  struct Candidate {
    std::string_view symbol;
    double unit_s;
  };
  constexpr std::array<Candidate, 4> candidates{
      {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
  const auto guessed = [&](const Candidate& candidate, bool is_date, std::string_view why) {
    const double rate_hz = 1.0 / (step * candidate.unit_s);
    return StampUnit{
        candidate.unit_s, stamps.origin, is_date,
        Note{Severity::info, fmt::format("{}: unit taken to be {} ({} Hz), as {}", stamps.name,
                                         candidate.symbol, in_words(rate_hz), why)}};
  };
  for (const Candidate& candidate : candidates) {
    const double rate_hz = 1.0 / (step * candidate.unit_s);
    if (is_of_this_age(stamps.origin.value() * candidate.unit_s) && rate_hz > 0.01 && rate_hz < 1e5)
      return guessed(candidate, true, "the first stamp is a date of this century in it");
  }
  const auto distance = [&](const Candidate& candidate) {
    return std::abs(std::log10(1.0 / (step * candidate.unit_s)) - 2.0);
  };
  return guessed(*std::ranges::min_element(candidates, {}, distance), false,
                 "of s, ms, us, ns it gives the rate nearest to 100 Hz");
}

/// Fractional seconds since 1904: a count of ticks of that size has steps of at least one.
std::optional<StampUnit> as_labview(const StampColumn& stamps, double step, bool is_stated) {
  const double first = stamps.origin.value();
  if (step > 0.5 || !is_of_this_age(first - static_cast<double>(from_1904_to_1970_s)))
    return std::nullopt;
  return StampUnit{
      1.0, less(stamps.origin, from_1904_to_1970_s), true,
      Note{Severity::info, fmt::format("{}: seconds since 1904, as LabVIEW counts{}", stamps.name,
                                       is_stated ? "" : ", by their size")}};
}

}  // namespace

StampUnit unit_of(const StampColumn& stamps, double step) {
  const bool is_stated = stamps.unit.quantity == Quantity::time;
  const double stated_s = stamps.unit.to_si;
  if (stamps.clock != StampClock::figures) return {stated_s, stamps.origin, true, std::nullopt};
  if (!is_stated || stated_s == 1.0)
    if (const auto unit = as_labview(stamps, step, is_stated)) return *unit;
  if (is_stated)
    return {stated_s, stamps.origin, is_of_this_age(stamps.origin.value() * stated_s),
            std::nullopt};
  if (const auto unit = as_xsens(stamps, step)) return *unit;
  if (const auto unit = as_days(stamps, step)) return *unit;
  return guess(stamps, step);
}

}  // namespace proofmass::io
