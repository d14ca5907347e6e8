#include "proofmass/io/time/wrap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace proofmass::io {
namespace {

bool is_whole(double reading) {
  return reading == std::trunc(reading);
}

}  // namespace

WrapFinder::WrapFinder(double unit_s) {
  constexpr std::array<int, 4> widths{16, 24, 31, 32};
  for (const int bits : widths)
    all_.push_back({0.0, std::ldexp(1.0, bits), fmt::format("{} bits", bits), true});
  constexpr std::array<int, 2> signed_widths{16, 32};
  for (const int bits : signed_widths)
    all_.push_back({-std::ldexp(1.0, bits - 1), std::ldexp(1.0, bits - 1),
                    fmt::format("{} bits with a sign", bits), true});
  constexpr std::array<double, 3> ticks_per_unit{1e3, 1e6, 1e9};
  for (const double ticks : ticks_per_unit)
    for (const int bits : {31, 32})
      all_.push_back({0.0, std::ldexp(1.0, bits) / ticks,
                      fmt::format("{} bits in {} parts of the unit", bits,
                                  ticks == 1e3   ? "thousandth"
                                  : ticks == 1e6 ? "millionth"
                                                 : "milliardth"),
                      false});
  all_.push_back({0.0, 86'400.0 / unit_s, "the day's end", false});
  all_.push_back({0.0, 604'800.0 / unit_s, "the week's end", false});
}

std::optional<std::size_t> WrapFinder::find(double last,
                                            double next,
                                            double usual,
                                            std::optional<std::size_t> seen) const {
  std::optional<std::size_t> best;
  double shortest = 0.0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const Wrap& wrap = all_[i];
    // The upper limit itself occurs if ticks are divided and rounded.
    if (!(last <= wrap.top) || !(next >= wrap.bottom)) continue;
    if (wrap.needs_whole && !(is_whole(last) && is_whole(next))) continue;
    const double way = next + wrap.range() - last;
    double longest = 100.0 * usual;
    if (wrap.needs_whole) longest = std::max(longest, wrap.range() / 64.0);
    if (seen != i)
      longest = std::min(longest, wrap.range() / 2.0);
    else
      longest = wrap.range() / 2.0;
    if (!(way >= 0.0) || way > longest || (best && way >= shortest)) continue;
    best = i;
    shortest = way;
  }
  return best;
}

}  // namespace proofmass::io
