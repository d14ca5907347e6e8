#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/counter_clock.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/stamps.hpp"
#include "proofmass/io/time_base.hpp"

namespace proofmass::io {

/// The time base of a recording whose rows come in pieces: decided on the first of them, then
/// folded over all. find_time_base() is the same where the first rows are all there are.
class RunningTimeBase {
 public:
  /// Rows that mend() may leave over at most; with more than these it settles one at least.
  static constexpr std::size_t most_unsettled = StampMender::most_unsettled;

  /// Decides on the first rows, which are looked at only: they are to be mended like the others.
  RunningTimeBase(const TimeEvidence& first_rows, const ReadOptions& options);

  /// Source, channel, rate and start; what was mended until now. Never with stamps_s.
  [[nodiscard]] const TimeBase& base() const { return base_; }
  /// Whether the column of stamps is no time base: then it is a channel like any other.
  [[nodiscard]] bool is_rejected() const { return rejected_; }
  /// Whether each row has a time of its own, which mend() gives; else rate and start say it all.
  [[nodiscard]] bool has_stamps() const {
    return base_.source == TimeSource::stamps || base_.source == TimeSource::counter;
  }

  /// Turns the stamps of the next rows, less the column's origin, into seconds since the first
  /// sample, in place: unrolled, mended. Says of how many: a stamp is judged by those behind it,
  /// so that the last few rows stay as they are unless this is the end; they are to stand in front
  /// of the next rows, in `stamps` and in `counter`. The result does not depend on how the rows
  /// are cut. `counter` is as long as `stamps`, or empty if there is none; where the counter is the
  /// time base `stamps` is only written. Expects has_stamps(). Cost: O(N).
  [[nodiscard]] std::size_t mend(std::span<double> stamps, View<double> counter, bool is_end);

  /// What was decided and why, and what was mended, complete once the end was mended. `first_line`
  /// is the recording's, which may be known at the end only.
  [[nodiscard]] std::vector<Note> notes(std::size_t first_line) const;
  [[nodiscard]] std::vector<Note> notes() const { return notes(first_line_); }

 private:
  friend TimeBaseFound find_time_base(TimeEvidence evidence, const ReadOptions& options);

  void decide_on_stamps(const TimeEvidence& rows);
  void decide_on_rate(const TimeEvidence& rows, double rate_hz);
  void take_rate(const StampSteps& steps);
  void update_counts();
  void to_seconds(std::span<double> stamps) const;

  TimeBase base_;
  bool rejected_ = false;
  double unit_s_ = 1.0;
  double first_ = 0.0;  ///< stamp of the first sample, less the origin
  std::size_t first_line_ = 0;
  std::string counter_name_;
  std::optional<double> header_rate_hz_;
  std::vector<Note> decisions_;
  std::vector<Note> rate_notes_;
  StampMender mender_;
  CounterClock counted_;
};

}  // namespace proofmass::io
