#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/block.hpp"

namespace proofmass::estimate {

/// Holds back the rows that follow a long interval and come early, as those do that a computer
/// stamped all at once after it was busy, until one is on time again; then they are spread evenly
/// over the interval. After a gap in which rows are missing, one row waits for the next.
class LiveLateRows {
 public:
  /// Whether the row waits. If it does not, take() has the rows that come before it. `last_s`: time
  /// of the last row that did not wait, not finite before the first; `rate_hz`: 0 if unknown.
  [[nodiscard]] bool holds(const Block& samples, std::size_t row, double last_s, double rate_hz);
  [[nodiscard]] bool empty() const { return stamps_s_.empty(); }
  /// The rows that waited; valid until the next call.
  [[nodiscard]] Block take();
  /// Number of rows whose time was changed since the last call.
  [[nodiscard]] std::size_t take_count();

 private:
  void keep(const Block& samples, std::size_t row);
  void spread(double on_time_s, double rate_hz);

  std::vector<std::vector<double>> channels_, taken_;  ///< a vector for each channel
  std::vector<double> stamps_s_, taken_s_;
  double from_s_ = 0.0;  ///< of the row before those that wait
  std::size_t count_ = 0;
};

}  // namespace proofmass::estimate
