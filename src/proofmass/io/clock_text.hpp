#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace proofmass::io {

/// A date, a time of day, or both, as a field of a table spells them.
struct ClockReading {
  std::optional<std::int64_t> days;  ///< since 1970-01-01
  std::optional<std::int64_t> ns;    ///< since midnight, less the zone's offset
  bool zone_given = false;           ///< without one the time is taken for UTC
};

/// Reads ISO 8601 and its relatives: "2024-01-17T08:14:46.069Z", "2024-01-17 08:14:46,069+02:00",
/// "2024/01/17 8:14", "17.01.2024 08:14:46", "2024-01-17 08:14:46.069 UTC+02:00", a date alone
/// ("2024-01-17"), a time of day alone ("08:14:46.069"). nullopt for anything else.
[[nodiscard]] std::optional<ClockReading> read_clock(std::string_view text);

/// The instant of a date with a time of day in nanoseconds since 1970; nullopt where either is
/// missing or it is beyond what 64 bits hold.
[[nodiscard]] std::optional<std::int64_t> instant_ns(const ClockReading& reading);

}  // namespace proofmass::io
