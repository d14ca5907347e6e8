#pragma once

#include <memory>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::signal {

/// Judges a recording that comes in pieces, in one pass; audit() is a fold over it. However the
/// recording is cut, the result is the same to the last digit.
///
/// All that RecordingAudit counts is counted exactly. The LSB is told by a ThinnedSample of 2^18
/// plausible values of a channel (fewer beyond 32 channels): up to there by all of them. So is how
/// much lies beside a rail, where that is more than the 2^13 values of a ValueTail. Limits with
/// noise behind them and soft ones are told by ValueExcerpts of 2^17 values.
///
/// Memory: 3.3 MiB a channel at most, 106 MiB in all up to 1024 channels; the lists of gaps and of
/// rows of zeros end at most_listed. Cost: about 1.5 ns a value.
class RunningAudit {
 public:
  /// head: channels without values, their names and units, the time base without stamps (its rate
  /// is what gaps and jitter are judged by), first_line.
  explicit RunningAudit(const Recording& head);
  RunningAudit(RunningAudit&&) noexcept;
  RunningAudit& operator=(RunningAudit&&) noexcept;
  ~RunningAudit();

  /// The samples behind those added before, of the head's channels; with stamps in every block or
  /// in none.
  void add(const Block& block);

  /// Once, when all is added. `head` is the recording's as known at the end: format, notes, names
  /// and units, the time base with the stamps that were mended; channels that turned out to be none
  /// may be missing from it.
  [[nodiscard]] RecordingAudit finish(const Recording& head);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::signal
