#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace proofmass::io {

/// A date, a time of day, or both, parsed from a field of a table.
struct ClockReading {
  std::optional<std::int64_t> days;  ///< since 1970-01-01
  std::optional<std::int64_t> ns;    ///< since midnight, minus the zone's offset
  bool zone_given = false;           ///< false: the time is assumed to be UTC
};

/// Parses ISO 8601 and related forms: "2024-01-17T08:14:46.069Z", "2024-01-17 08:14:46,069+02:00",
/// "2024/01/17 8:14", "17.01.2024 08:14:46", "2024-01-17 08:14:46.069 UTC+02:00", a date alone
/// ("2024-01-17"), a time of day alone ("08:14:46.069"). nullopt for anything else.
[[nodiscard]] std::optional<ClockReading> read_clock(std::string_view text);

/// A date and time of day in nanoseconds since 1970; nullopt if either is missing or the result
/// exceeds 64 bits.
[[nodiscard]] std::optional<std::int64_t> instant_ns(const ClockReading& reading);

}  // namespace proofmass::io
