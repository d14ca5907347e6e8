#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "proofmass/io/decimal.hpp"

namespace proofmass::io {

__extension__ using Int128 = __int128;

/// The first stamp of a file, exact: mantissa · 10^exponent10 in the column's own unit.
struct StampOrigin {
  Int128 mantissa = 0;
  int exponent10 = 0;

  [[nodiscard]] double value() const;
  /// In nanoseconds, rounded, for a unit of `unit_s` seconds; nullopt beyond ±292 years.
  [[nodiscard]] std::optional<std::int64_t> ns(double unit_s) const;
};

/// Format of the fields of a time column.
enum class StampSpelling {
  figures,          ///< numbers in any unit
  clock,            ///< date and time, or time of day, in one field
  date_then_clock,  ///< the date in one column, the time of day in the next
};

/// Converts a time column to differences from its first stamp, each the double nearest to the exact
/// decimal difference: an epoch in nanoseconds has more digits than a double.
class StampReader {
 public:
  StampReader(StampSpelling spelling, char point) : spelling_(spelling), point_(point) {}

  [[nodiscard]] StampSpelling spelling() const { return spelling_; }
  [[nodiscard]] const std::optional<StampOrigin>& origin() const { return origin_; }
  [[nodiscard]] bool zone_missing() const { return zone_missing_; }

  /// The usual case, numbers with a constant count of decimals; false for any other.
  bool relative(const Decimal& stamp, double& out) const {
    if (stamp.exponent10 != narrow_exponent10_ || stamp.mantissa > std::uint64_t{narrow_limit})
      return false;
    const auto size = static_cast<std::int64_t>(stamp.mantissa);
    const std::int64_t difference = (stamp.negative ? -size : size) - narrow_mantissa_;
    const auto magnitude = static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
    return to_double_exactly({magnitude, stamp.exponent10, difference < 0}, out);
  }
  /// Any field; NaN if it is not a stamp. `date` is the preceding column, if there is one.
  double read(std::string_view field, std::string_view date = {});

 private:
  double read_clock_fields(std::string_view field, std::string_view date);
  double difference(Int128 mantissa, int exponent10);
  void set_origin(const StampOrigin& origin);

  StampSpelling spelling_;
  char point_;
  std::optional<StampOrigin> origin_;
  // The origin again if 62 bits hold it; otherwise the exponent is one that no stamp has.
  static constexpr std::int64_t narrow_limit = std::int64_t{1} << 62;
  std::int64_t narrow_mantissa_ = 0;
  int narrow_exponent10_ = std::numeric_limits<int>::min();
  bool zone_missing_ = false;
  std::int64_t day_ = 0;          ///< number of midnights passed, if only the time of day is given
  std::int64_t last_of_day_ = 0;  ///< ns
};

}  // namespace proofmass::io
