#pragma once

#include <cstddef>

#include "proofmass/core/result.hpp"

namespace proofmass::signal {

/// Lays recordings of one sensor behind each other on one even grid, as if they were one recording
/// with gaps. Each is placed by its start on a clock common to all, so that rounding does not
/// accumulate. One that starts up to a second before the end of the previous one follows it
/// directly: the start of a file is often known to the second only.
class RecordingSequence {
 public:
  /// rate_hz > 0: of all recordings.
  explicit RecordingSequence(double rate_hz) : rate_hz_(rate_hz) {}

  /// Samples missing between the previous recording and this one, of `samples` samples. Errors:
  /// invalid_argument (it starts more than a second before the end of the previous one).
  [[nodiscard]] Result<std::size_t> append(double start_s, std::size_t samples);

  /// Samples so far, with the missing ones.
  [[nodiscard]] std::size_t samples() const { return samples_; }

 private:
  double rate_hz_;
  double first_start_s_ = 0.0;
  std::size_t samples_ = 0;
};

}  // namespace proofmass::signal
