#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// A timestamp as stored by LabVIEW.
struct TdmsInstant {
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
[[nodiscard]] TdmsInstant tdms_instant(std::int64_t unix_ns);

/// The value of a property; numbers of any type are the nearest double.
using TdmsValue = std::variant<double, std::string, TdmsInstant>;

/// Properties of a file, a group or a channel; later segments override earlier ones.
using TdmsProperties = std::map<std::string, TdmsValue, std::less<>>;

[[nodiscard]] std::optional<double> number_of(const TdmsProperties& properties,
                                              std::string_view name);
/// Empty if there is none.
[[nodiscard]] std::string text_of(const TdmsProperties& properties, std::string_view name);
[[nodiscard]] std::optional<TdmsInstant> instant_of(const TdmsProperties& properties,
                                                    std::string_view name);

}  // namespace proofmass::io
