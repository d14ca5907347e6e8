#pragma once

#include <string>
#include <vector>

// Where an axis is marked, and how the marks read.
namespace proofmass::report {

struct Tick {
  double value = 0.0;
  std::string label;
};

/// Marks from `low` to `high`: 1, 2 or 5 times a power of ten apart, at most `most` + 1 of them,
/// with as many decimals as they need and a power of ten taken out of very large and very small
/// ones. Empty if the range is empty, not finite, or too narrow for doubles to tell its ends apart.
[[nodiscard]] std::vector<Tick> linear_ticks(double low, double high, int most);

/// Powers of ten within [low, high], both positive, "10⁻³"; 2 and 5 times them too where there is
/// room, and every second, third … power where there are more than `most`. Where fewer than two lie
/// inside, linear_ticks of the same range.
[[nodiscard]] std::vector<Tick> log_ticks(double low, double high, int most);

}  // namespace proofmass::report
