#include "proofmass/io/time/stamp_shift.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace proofmass::io {
namespace {

constexpr Int128 largest =
    std::numeric_limits<std::int64_t>::max() * Int128{10'000'000'000'000'000};

/// `value` · 10^`power`; nullopt beyond what is plausible for a stamp.
std::optional<Int128> times_ten_to(Int128 value, int power) {
  for (; power > 0 && value != 0; --power) {
    if (value > largest || value < -largest) return std::nullopt;
    value *= 10;
  }
  return value;
}

}  // namespace

StampOrigin moved(const StampOrigin& origin, std::int64_t by_ns) {
  constexpr int ns_exponent = -9;
  const int exponent = std::min(origin.exponent10, ns_exponent);
  const auto was = times_ten_to(origin.mantissa, origin.exponent10 - exponent);
  const auto by = times_ten_to(by_ns, ns_exponent - exponent);
  if (!was || !by) return origin;
  return {*was + *by, exponent};
}

}  // namespace proofmass::io
