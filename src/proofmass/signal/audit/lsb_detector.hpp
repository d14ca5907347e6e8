#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"

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
  /// Adds the values of samples k, k + 1, …
  void add(std::size_t k, View<double> values) {
    constexpr std::size_t chunk = 256;
    for (std::size_t from = 0; from < values.size(); from += chunk) {
      const View<double> part = values.subspan(from, std::min(chunk, values.size() - from));
      add_chunk(k + from, part);
    }
  }
  /// Zero if the smallest step is never reversed: it is then a step between levels.
  [[nodiscard]] double quantum() const {
    return std::isfinite(least_) && least_returned_ <= 1.5 * least_ ? least_ : 0.0;
  }

 private:
  void add_chunk(std::size_t k, View<double> values) {
    // After two values the previous ones are part of the chunk.
    const std::size_t begun = std::min<std::size_t>(2, values.size());
    for (std::size_t j = 0; j < begun; ++j) add(k + j, values[j]);
    const std::size_t last = values.size() - 1;
    if (last < 2) return;
    if (values[0] == values[1] || steps_are_fine_or_reversed(values, least_)) {
      for (std::size_t j = begun; j <= last; ++j) add(k + j, values[j]);
      return;
    }
    before_ = values[last - 1];
    now_ = values[last];
    changed_ = k + last;
  }

  static constexpr double infinity = std::numeric_limits<double>::infinity();
  std::size_t soon_, changed_ = 0;
  double now_ = std::numeric_limits<double>::quiet_NaN(), before_ = now_;
  double least_ = infinity, least_returned_ = infinity;
};

}  // namespace proofmass::signal
