#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io::tdms {

/// A timestamp as stored by LabVIEW.
struct Instant {
  std::int64_t seconds = 0;    ///< since 1904-01-01 00:00 UTC
  std::uint64_t fraction = 0;  ///< fraction of a second, in 2^-64 s

  /// 1904 itself means that no time is set.
  [[nodiscard]] bool is_set() const { return seconds != 0 || fraction != 0; }
  /// Nanoseconds since 1970-01-01 00:00 UTC, rounded.
  [[nodiscard]] Int128 wide_ns() const;
  /// The same; nullopt beyond ±292 years, and if no time is set.
  [[nodiscard]] std::optional<std::int64_t> unix_ns() const;
};

/// The reverse, exact: unix_ns() returns the same value.
[[nodiscard]] Instant instant_at(std::int64_t unix_ns);

/// The value of a property; numbers of any type are the nearest double.
using Value = std::variant<double, std::string, Instant>;

/// Properties of a file, a group or a channel; later segments override earlier ones.
using Properties = std::map<std::string, Value, std::less<>>;

[[nodiscard]] std::optional<double> number_of(const Properties& properties, std::string_view name);
/// Empty if there is none.
[[nodiscard]] std::string text_of(const Properties& properties, std::string_view name);
[[nodiscard]] std::optional<Instant> instant_of(const Properties& properties,
                                                std::string_view name);

}  // namespace proofmass::io::tdms
