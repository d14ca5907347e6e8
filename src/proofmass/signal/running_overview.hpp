#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::signal {

/// What a picture of a recording needs that comes in pieces and is not kept: the smallest and the
/// largest value of each of a few thousand spans of equally many samples. The spans double in
/// length whenever there are too many. Values that are not is_plausible are left out.
class RunningOverview {
 public:
  explicit RunningOverview(std::size_t channels);

  void add(const Block& block);

  /// Samples in a span.
  [[nodiscard]] std::size_t span() const { return span_; }

  /// `head`, with two samples of each channel a span, the smallest and the largest value, NaN in
  /// spans without any, at the time of the span's first sample.
  [[nodiscard]] Recording finish(const Recording& head) const;

 private:
  struct Range {
    double low, high;
  };
  void close_span();
  void halve();

  std::vector<std::vector<Range>> closed_;  ///< a channel each
  std::vector<Range> open_;
  std::vector<double> stamps_s_;  ///< of the spans' first samples; empty where there are none
  std::size_t spans_ = 0;
  std::size_t span_ = 64;
  std::size_t filled_ = 0;  ///< samples in the open span
};

}  // namespace proofmass::signal
