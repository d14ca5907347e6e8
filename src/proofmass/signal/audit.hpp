#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::signal {

/// Values above this magnitude are decoding errors, not measurements: 3e34 and the like.
inline constexpr double absurd_magnitude = 1e15;

/// Maximum length of a list of positions; its count is not limited.
inline constexpr std::size_t most_listed = 1'000'000;

/// How the range of a channel clips it.
enum class Clipping {
  none,
  rail,          ///< at the exact lowest or highest value
  before_noise,  ///< at a level, with noise added after the limit
  soft,          ///< compressed towards a level
  undetermined,  ///< crests flatter than a sine's and all alike: soft clipping, or the shape of the
                 ///< motion
};

/// Statistics of one channel. Moments, LSB and clipping use the plausible values: the finite ones
/// that are below absurd_magnitude and not denormal.
struct ChannelAudit {
  std::string name;
  Unit unit;
  Moments moments;            ///< mean, std(), min, max of the plausible values
  std::optional<double> lsb;  ///< quantisation step, in the channel's unit; none if continuous
  std::size_t nonfinite = 0;  ///< NaN and infinities; `infinite` counts the infinities
  std::size_t infinite = 0;
  std::size_t absurd = 0;    ///< |x| > absurd_magnitude
  std::size_t denormal = 0;  ///< 0 < |x| < 1.2e-38, a float's smallest normal: misinterpreted bytes
  Clipping clipping = Clipping::none;
  /// Samples at the limits: in runs of three or more at the lowest or highest value; within the
  /// noise of the level; on compressed crests.
  std::size_t clipped = 0;
  std::optional<double> limit_low, limit_high;  ///< or where compression of the crests begins
  std::size_t longest_stuck = 0;  ///< length of the longest run of one value, in samples
  double longest_stuck_start_s = 0.0;
};

/// A gap in the stamps: two samples more than 1.5 nominal periods apart. Where single intervals are
/// not conclusive (TimeBase::band_s): missing samples found by StampBand, located to within a few
/// rows.
struct Gap {
  double start_s = 0.0;     ///< time of the last sample before it, from the first sample
  double duration_s = 0.0;  ///< from that sample to the next; by StampBand in whole nominal periods
};

/// Regularity of the sampling.
struct TimingAudit {
  TimeSource source = TimeSource::none;
  std::string channel;   ///< source column of the time base; empty if none
  double rate_hz = 0.0;  ///< 0 if unknown
  /// Standard deviation of rate_hz as an estimate of the sample rate on the stamps' own clock, by
  /// RateLine; none without stamps, or where they are exactly even.
  std::optional<double> rate_std_hz;
  /// Samples, including missing ones, over the duration; rate_hz itself where the two differ by
  /// more than 2 % or time runs backwards. None without stamps.
  std::optional<double> long_run_hz;
  std::optional<double> jitter_s;  ///< std of the intervals about the nominal period, gaps
                                   ///< excluded; none without stamps
  std::vector<Gap> gaps;           ///< the first most_listed gaps
  std::size_t gap_count = 0;       ///< all gaps
  Gap longest_gap;                 ///< the earliest if several are as long; duration 0 if none
  std::size_t stalls = 0;          ///< intervals of more than three periods without a missing
                                   ///< sample: the samples after it were stamped late
  double longest_stall_s = 0.0, longest_stall_start_s = 0.0;
  std::size_t backwards = 0;        ///< stamps below the previous one, corrected ones included
  std::size_t repeated = 0;         ///< stamps equal to the previous one
  std::size_t mended = 0;           ///< stamps that the reader replaced: not a number, or far off
  std::optional<std::size_t> lost;  ///< rows missing by the packet counter; none without one
};

/// Content and quality of a recording.
struct RecordingAudit {
  std::string format;
  std::size_t samples = 0;
  double duration_s = 0.0;
  std::vector<ChannelAudit> channels;  ///< in the order of the recording
  TimingAudit timing;
  std::vector<std::size_t> zero_rows;  ///< samples where every inertial channel is exactly 0
  std::size_t zero_row_count = 0;      ///< their number; the list holds the first most_listed
  /// Notes of the reader, then of the audit, one sentence each with its location.
  std::vector<Note> notes;

  /// True if any note is Severity::bad, on which `--strict` fails.
  [[nodiscard]] bool is_bad() const;
};

/// Audits a recording's channels and timing in one call; built on RunningAudit.
///
/// - Jitter: root mean square of interval − 1/rate, over the intervals within half a nominal period
///   of it.
/// - LSB: the step of which the differences between adjacent distinct values are whole multiples,
///   fitted with weights by their number of occurrences; none if fewer than half of the values
///   repeat another.
/// - Rail clipping: the exact extreme occurs three or more times in a row, and more often than the
///   adjacent fiftieth of the range; only for channels that a converter's range can clip. If the
///   LSB is known, the signal must also run into the rail, because a coarsely quantised crest or a
///   static position stays at its extreme for long as well.
/// - If there is no rail: see audit/range_limit.hpp for limits with noise added afterwards and for
/// soft
///   limits.
///
/// For LSB and clipping of recordings of more than 131 072 samples see running_audit.hpp. Cost: one
/// pass, and a sort of at most a quarter of a million values of each channel.
[[nodiscard]] RecordingAudit audit(const Recording& recording);

}  // namespace proofmass::signal
