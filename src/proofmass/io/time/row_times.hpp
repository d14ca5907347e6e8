#pragma once

#include <cstddef>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// The times of a block's rows in seconds from the recording's first sample.
class RowTimes {
 public:
  explicit RowTimes(const TimeBase& time) : is_timed_(time.source != TimeSource::none) {
    even_.rate_hz = time.rate_hz;
  }

  [[nodiscard]] bool is_timed() const { return is_timed_; }
  [[nodiscard]] double at(const Block& block, std::size_t row) const {
    return block.stamps_s.empty() ? even_.at(block.first + row) : block.stamps_s[row];
  }

 private:
  TimeBase even_;
  bool is_timed_;
};

}  // namespace proofmass::io
