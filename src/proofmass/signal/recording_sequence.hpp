#pragma once

#include <cstddef>
#include <limits>

#include "proofmass/core/result.hpp"

namespace proofmass::signal {

/// Places recordings of one sensor one after another on one even grid, as if they were one
/// recording with gaps. Each is placed by its start on a clock common to all, so that rounding does
/// not accumulate. One that starts up to a second before the end of the previous one follows it
/// directly: the start of a file is often known to the second only. Gaps may be bounded: a week
/// between two hours need not be laid out sample by sample.
class RecordingSequence {
 public:
  /// rate_hz > 0: of all recordings. longest_gap: samples; longer ones are shortened to it.
  explicit RecordingSequence(double rate_hz,
                             std::size_t longest_gap = std::numeric_limits<std::size_t>::max())
      : rate_hz_(rate_hz), longest_gap_(longest_gap) {}

  /// Samples missing between the previous recording and this one, of `samples` samples. Errors:
  /// invalid_argument (it starts more than a second before the end of the previous one).
  [[nodiscard]] Result<std::size_t> append(double start_s, std::size_t samples);

  /// Samples so far, with the missing ones.
  [[nodiscard]] std::size_t samples() const { return samples_; }

 private:
  double rate_hz_;
  std::size_t longest_gap_;
  double first_start_s_ = 0.0;
  double end_ = 0.0;  ///< of the previous recording, samples behind the first start
  std::size_t samples_ = 0;
};

}  // namespace proofmass::signal
