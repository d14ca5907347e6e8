#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

namespace proofmass::signal {

/// Tracks the smallest step of an axis and the smallest reversed step, such as noise between two
/// codes of a converter.
class LsbDetector {
 public:
  explicit LsbDetector(std::size_t soon) : soon_(soon) {}

  void add(std::size_t k, double x) {
    if (x == now_) return;
    const double step = std::abs(x - now_);  // NaN at first, for which every comparison is false
    if (step < least_) least_ = step;
    if (x == before_ && step < least_returned_ && k - changed_ <= soon_) least_returned_ = step;
    before_ = now_;
    now_ = x;
    changed_ = k;
  }
  /// Zero if the smallest step is never reversed: it is then a step between levels.
  [[nodiscard]] double quantum() const {
    return std::isfinite(least_) && least_returned_ <= 1.5 * least_ ? least_ : 0.0;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  std::size_t soon_, changed_ = 0;
  double now_ = std::numeric_limits<double>::quiet_NaN(), before_ = now_;
  double least_ = infinity, least_returned_ = infinity;
};

}  // namespace proofmass::signal
