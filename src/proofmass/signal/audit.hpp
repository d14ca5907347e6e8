#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::signal {

/// Values beyond this size are no measurement but a decoder's accident: 3e34 and the like.
inline constexpr double absurd_magnitude = 1e15;

/// A list of places ends here; its count does not.
inline constexpr std::size_t most_listed = 1'000'000;

/// How the range of a channel cuts it off.
enum class Clipping {
  none,
  rail,          ///< at the exact lowest or highest value
  before_noise,  ///< at a level that noise was added to behind it
  soft,          ///< bent towards a level
  undetermined,  ///< crests flatter than an oscillation's and all alike: soft, or the motion's
                 ///< shape
};

/// What one channel's figures look like. Moments, LSB and clipping are over the plausible values:
/// the finite ones that are below absurd_magnitude and not denormal.
struct ChannelAudit {
  std::string name;
  Unit unit;
  Moments moments;            ///< mean, std(), min, max of the plausible values
  std::optional<double> lsb;  ///< step of the converter, in the channel's unit; none if continuous
  std::size_t nonfinite = 0;  ///< NaN and infinities, of which `infinite` are infinities
  std::size_t infinite = 0;
  std::size_t absurd = 0;    ///< |x| > absurd_magnitude
  std::size_t denormal = 0;  ///< 0 < |x| < 1.2e-38, a float's smallest normal: bytes misread
  Clipping clipping = Clipping::none;
  /// Samples at the limits: in runs of three or more at the lowest or highest value; within the
  /// noise of the level; on crests that are bent.
  std::size_t clipped = 0;
  std::optional<double> limit_low, limit_high;  ///< or where the crests begin to be bent
  std::size_t longest_stuck = 0;  ///< samples of the longest run of one and the same value
  double longest_stuck_start_s = 0.0;
};

/// A hole in the stamps: two samples further apart than 1.5 nominal steps. Where single steps do
/// not tell (TimeBase::band_s): samples missing by StampBand, within some rows of their place.
struct Gap {
  double start_s = 0.0;     ///< time of the last sample before it, since the first sample
  double duration_s = 0.0;  ///< from that sample to the next; by StampBand in whole nominal steps
};

/// How regular the sampling was.
struct TimingAudit {
  TimeSource source = TimeSource::none;
  std::string channel;   ///< column behind the time base; empty if none
  double rate_hz = 0.0;  ///< 0 if unknown
  /// Standard deviation of rate_hz as a measure of the samples a second of the stamps' own clock,
  /// by RateLine; none without stamps, or where they are even to the last digit.
  std::optional<double> rate_std_hz;
  /// Samples, missing ones counted, over the duration; rate_hz itself where that is off by more
  /// than 2 % or time runs backwards. None without stamps.
  std::optional<double> long_run_hz;
  std::optional<double> jitter_s;  ///< std of the steps about the nominal one, gaps left out; none
                                   ///< where there are no stamps
  std::vector<Gap> gaps;           ///< the first most_listed of them
  std::size_t gap_count = 0;       ///< all
  Gap longest_gap;                 ///< the first such; of no duration where there is none
  std::size_t backwards = 0;  ///< stamps below the one before, those that the reader mended too
  std::size_t repeated = 0;   ///< stamps equal to the one before
  std::size_t mended = 0;     ///< stamps that the reader replaced, being no number or far off
  std::optional<std::size_t> lost;  ///< rows missing by the file's packet counter; none without one
};

/// What is in a recording and how good it is.
struct RecordingAudit {
  std::string format;
  std::size_t samples = 0;
  double duration_s = 0.0;
  std::vector<ChannelAudit> channels;  ///< in the order of the recording
  TimingAudit timing;
  std::vector<std::size_t> zero_rows;  ///< samples at which every inertial channel reads exactly 0
  std::size_t zero_row_count = 0;      ///< of them; the list has the first most_listed
  /// What the reader noted, then what the audit found, each a sentence with its place.
  std::vector<Note> notes;

  /// Whether any note is Severity::bad: what `--strict` asks.
  [[nodiscard]] bool is_bad() const;
};

/// Judges a recording's channels and timing: a fold over RunningAudit.
/// Jitter is the root mean square of step − 1/rate over the steps within half a nominal step of it.
/// The LSB is the step that the differences between neighbouring distinct values are whole
/// multiples of, fitted by how often they are read; none if fewer than half of the values repeat
/// one another. Values count as clipped where the exact extreme is read three times running or
/// more, and more often than the fiftieth of the range next to it; only channels that a converter's
/// range can clip. Where the LSB is known, the signal has to run into the rail, too: a crest in
/// coarse steps, or a position at rest, reads its extreme for long as well. Where no
/// rail is found, range_limit.hpp says how a limit with noise behind it and a soft one are told. Of
/// LSB and clipping see running_audit.hpp for recordings of more than 131 072 samples. Cost: one
/// pass, and a sort of at most a quarter of a million values of each channel.
[[nodiscard]] RecordingAudit audit(const Recording& recording);

}  // namespace proofmass::signal
