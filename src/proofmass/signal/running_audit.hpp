#pragma once

#include <memory>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::signal {

/// Audits a recording in blocks, in one pass; audit() uses it. The result does not depend on the
/// block boundaries, to the last digit.
///
/// - All counts of RecordingAudit are exact.
/// - The LSB is determined from a Subsample of 2^18 plausible values per channel (fewer beyond
///   32 channels), which holds all values of shorter recordings. So is the number of values near a
///   rail, if it exceeds the 2^13 values of a ClippingTail.
/// - Limits with noise added afterwards and soft limits are determined from ValueExcerpts of 2^17
///   values.
///
/// Memory: at most 3.3 MiB per channel, 106 MiB in all up to 1024 channels; the lists of gaps and
/// of all-zero rows end at most_listed. Cost: about 1.5 ns per value.
class RunningAudit {
 public:
  /// head: channels without values, their names and units, the time base without stamps (its rate
  /// is the reference for gaps and jitter), first_line.
  explicit RunningAudit(const Recording& head);
  RunningAudit(RunningAudit&&) noexcept;
  RunningAudit& operator=(RunningAudit&&) noexcept;
  ~RunningAudit();

  /// The next samples, of the head's channels; with stamps in every block or in none.
  void add(const Block& block);

  /// Call once, after all samples are added. `head` is the recording's as known at the end: format,
  /// notes, names and units, the time base with the corrected stamps; columns that turned out not
  /// to be channels may be missing from it.
  [[nodiscard]] RecordingAudit finish(const Recording& head);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::signal
