#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/time/counter_clock.hpp"
#include "proofmass/io/time/stamps.hpp"
#include "proofmass/io/time_base.hpp"

namespace proofmass::io {

/// The time base of a recording whose rows arrive in blocks: determined from the first rows, then
/// applied to all. Equal to find_time_base() if the first rows are all rows.
class RunningTimeBase {
 public:
  /// Maximum number of rows that mend() leaves undecided; with more it decides at least one.
  static constexpr std::size_t most_unsettled = StampMender::most_unsettled;

  /// Decides from the first rows, which are only inspected: they still have to be corrected by
  /// mend().
  RunningTimeBase(const TimeEvidence& first_rows, const ReadOptions& options);

  /// Source, channel, rate and start; corrections so far. Never with stamps_s.
  [[nodiscard]] const TimeBase& base() const { return base_; }
  /// True if the column of stamps is not a time base: it is then an ordinary channel.
  [[nodiscard]] bool is_rejected() const { return rejected_; }
  /// True if each row has its own time, given by mend(); else rate and start are sufficient.
  [[nodiscard]] bool has_stamps() const {
    return base_.source == TimeSource::stamps || base_.source == TimeSource::counter;
  }

  /// Converts the stamps of the next rows, relative to the column's origin, to seconds from the
  /// first sample, in place: unwrapped and corrected. Returns the number of rows done.
  ///
  /// - A stamp is judged by the following ones, so the last few rows remain unchanged unless this
  ///   is the end; pass them again before the next rows, in `stamps` and in `counter`.
  /// - The result does not depend on the block boundaries.
  /// - `counter` is as long as `stamps`, or empty if there is none; if the counter is the time
  ///   base, `stamps` is output only.
  ///
  /// Expects has_stamps(). Cost: O(N).
  [[nodiscard]] std::size_t mend(std::span<double> stamps, View<double> counter, bool is_end);

  /// The decisions with their reasons, and the corrections; complete after the end was corrected.
  /// `first_line` is the recording's, which may be known at the end only.
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
  double first_ = 0.0;  ///< stamp of the first sample, minus the origin
  std::size_t first_line_ = 0;
  std::string counter_name_;
  std::optional<double> header_rate_hz_;
  std::vector<Note> decisions_;
  std::vector<Note> rate_notes_;
  StampMender mender_;
  CounterClock counted_;
};

}  // namespace proofmass::io
