#pragma once

#include <cstddef>
#include <span>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Whether a counter goes up by one nine times in ten, and never back but where 8, 16, 24 or 32
/// bits run over: then it says which rows are lost.
[[nodiscard]] bool counts_samples(View<double> counter);

/// Times by a sample counter of known rate, row after row.
class CounterClock {
 public:
  CounterClock() = default;
  explicit CounterClock(double rate_hz) : rate_hz_(rate_hz) {}

  /// Puts seconds since the first row into `times_s`, as many as there are counts. Where a count is
  /// no number, or falls back and nothing ran over, it goes on by one.
  void place(View<double> counter, std::span<double> times_s);
  [[nodiscard]] std::size_t lost() const { return lost_; }          ///< counts that no row has
  [[nodiscard]] std::size_t restarts() const { return restarts_; }  ///< falls that are no wrap

 private:
  double rate_hz_ = 1.0;
  bool started_ = false;
  double last_ = 0.0;   ///< count before, as read
  double total_ = 0.0;  ///< counts since the first row
  std::size_t lost_ = 0;
  std::size_t restarts_ = 0;
};

}  // namespace proofmass::io
