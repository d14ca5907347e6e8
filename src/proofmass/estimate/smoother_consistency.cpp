#include "proofmass/estimate/smoother_consistency.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::estimate {

void AuxiliaryTally::add(double residual, double variance) {
  if (!std::isfinite(residual) || !std::isfinite(variance) || variance <= 0.0) return;
  constexpr double largest = 1e9;  // its square's square must stay finite
  const double size = std::min(std::abs(residual) / std::sqrt(variance), largest);
  furthest_ = std::max(furthest_, size);
  ++count_;
  squares_ += size * size;
  double sum = size * size;
  for (Level& level : levels_) {
    ++level.count;
    level.sums += sum;
    level.squares += sum * sum;
    level.has_half = !level.has_half;
    if (level.has_half) {
      level.half = sum;
      return;
    }
    sum += level.half;
  }
}

// The longest stretches that are still numerous enough include the correlation best.
std::optional<Uncertain> AuxiliaryTally::mean_square() const {
  constexpr std::size_t enough = 32;
  std::optional<Uncertain> found;
  double length = 1.0;
  for (const Level& level : levels_) {
    if (level.count < enough) break;
    const auto n = static_cast<double>(level.count);
    const double variance =
        std::max(level.squares / n - level.sums / n * (level.sums / n), 0.0) / (n - 1.0);
    found = Uncertain{squares_ / static_cast<double>(count_), std::sqrt(variance) / length};
    length *= 2.0;
  }
  return found;
}

}  // namespace proofmass::estimate
