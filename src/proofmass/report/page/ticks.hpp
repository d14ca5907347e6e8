#pragma once

#include <string>
#include <vector>

// Positions and labels of axis ticks.
namespace proofmass::report {

struct Tick {
  double value = 0.0;
  std::string label;
};

/// Ticks from `low` to `high`, spaced by 1, 2 or 5 times a power of ten; at most `most` + 1 of
/// them, with as many decimals as they need. A common power of ten is factored out of very large
/// and very small values. Empty if the range is empty, not finite, or too narrow for double
/// precision.
[[nodiscard]] std::vector<Tick> linear_ticks(double low, double high, int most);

/// Powers of ten within [low, high], both positive, "10⁻³"; also 2 and 5 times them if there is
/// room, and every second, third … power if there are more than `most`. If fewer than two are
/// inside, linear_ticks of the same range.
[[nodiscard]] std::vector<Tick> log_ticks(double low, double high, int most);

}  // namespace proofmass::report
