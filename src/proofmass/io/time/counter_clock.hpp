#pragma once

#include <cstddef>
#include <span>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// True if a counter increments by one in nine of ten rows, and decreases only where 8, 16, 24 or
/// 32 bits wrap: then it identifies lost rows.
[[nodiscard]] bool counts_samples(View<double> counter);

/// Times from a sample counter of known rate, row by row.
class CounterClock {
 public:
  CounterClock() = default;
  explicit CounterClock(double rate_hz) : rate_hz_(rate_hz) {}

  /// Fills `times_s`, one per count, with seconds from the first row. If a count is not a number,
  /// or decreases without a wrap, time advances by one count.
  void place(View<double> counter, std::span<double> times_s);
  [[nodiscard]] std::size_t lost() const { return lost_; }  ///< counts without a row
  [[nodiscard]] std::size_t restarts() const {
    return restarts_;
  }  ///< decreases that are not a
     ///< wrap

 private:
  double rate_hz_ = 1.0;
  bool started_ = false;
  double last_ = 0.0;   ///< previous count, as read
  double total_ = 0.0;  ///< counts since the first row
  std::size_t lost_ = 0;
  std::size_t restarts_ = 0;
};

}  // namespace proofmass::io
