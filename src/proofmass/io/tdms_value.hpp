#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// A point in time as LabVIEW stores it.
struct TdmsInstant {
  std::int64_t seconds = 0;    ///< since 1904-01-01 00:00 UTC
  std::uint64_t fraction = 0;  ///< of a second, in 2^-64 s

  /// 1904 itself stands for no time at all.
  [[nodiscard]] bool is_set() const { return seconds != 0 || fraction != 0; }
  /// Nanoseconds since 1970-01-01 00:00 UTC, to the nearest.
  [[nodiscard]] Int128 wide_ns() const;
  /// The same; nullopt beyond ±292 years, and where no time is set.
  [[nodiscard]] std::optional<std::int64_t> unix_ns() const;
};

/// The other way, exact: unix_ns() gives the same figure back.
[[nodiscard]] TdmsInstant tdms_instant(std::int64_t unix_ns);

/// The value of a property; numbers of any type are the nearest double.
using TdmsValue = std::variant<double, std::string, TdmsInstant>;

/// What a file says of itself, of a group or of a channel; a later segment's word replaces an
/// earlier one's.
using TdmsProperties = std::map<std::string, TdmsValue, std::less<>>;

[[nodiscard]] std::optional<double> number_of(const TdmsProperties& properties,
                                              std::string_view name);
/// Empty where there is none.
[[nodiscard]] std::string text_of(const TdmsProperties& properties, std::string_view name);
[[nodiscard]] std::optional<TdmsInstant> instant_of(const TdmsProperties& properties,
                                                    std::string_view name);

}  // namespace proofmass::io
