#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::signal {

/// Data for a plot of a recording that arrives in blocks and is not kept: minimum and maximum of
/// each of a few thousand spans of equal length. The spans double in length whenever there are too
/// many. Implausible values (is_plausible) are omitted.
class RunningOverview {
 public:
  explicit RunningOverview(std::size_t channels);

  void add(const Block& block);

  /// Samples per span.
  [[nodiscard]] std::size_t span() const { return span_; }

  /// `head` with two samples of each channel per span, its minimum and maximum, NaN in empty spans,
  /// at the time of the span's first sample.
  [[nodiscard]] Recording finish(const Recording& head) const;

 private:
  struct Range {
    double low, high;
  };
  void close_span();
  void halve();

  std::vector<std::vector<Range>> closed_;  ///< one vector per channel
  std::vector<Range> open_;
  std::vector<double> stamps_s_;  ///< stamps of the spans' first samples; empty if there are none
  std::size_t spans_ = 0;
  std::size_t span_ = 64;
  std::size_t filled_ = 0;  ///< samples in the open span
};

}  // namespace proofmass::signal
