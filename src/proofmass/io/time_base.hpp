#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// Original form of a column of stamps.
enum class StampClock {
  figures,  ///< numbers
  wall,     ///< dates or times of day without a zone: daylight saving may begin or end
  zoned,    ///< with a zone
};

/// A column of stamps as found by a reader.
struct StampColumn {
  std::string name;
  Unit unit;                   ///< Quantity::unknown: determined from the magnitude
  StampOrigin origin;          ///< exact first stamp
  std::vector<double> values;  ///< stamps minus the origin, in `unit`; NaN if missing
  bool is_named = true;        ///< false: identified as a time only because it increases
  StampClock clock = StampClock::figures;
};

/// All information of a file on the times of its samples.
struct TimeEvidence {
  std::optional<StampColumn> stamps;
  std::string counter_name;              ///< empty if there is no counter
  View<double> counter;                  ///< the instrument's sample counter
  std::optional<double> header_rate_hz;  ///< a rate in the file's preamble
  std::size_t samples = 0;
  std::size_t first_line = 0;  ///< as in Recording
};

struct TimeBaseFound {
  TimeBase base;
  std::vector<Note> notes;
  /// The column of stamps, returned if it is not a time base.
  std::optional<StampColumn> rejected;
};

/// Determines the time base: --rate takes precedence over stamps, stamps over a rate in the
/// preamble.
///
/// - Unit of stamps: from the header, else from their magnitude (stamp_unit.hpp).
/// - Wraps are unwrapped and invalid stamps corrected (time/stamps.hpp); gaps and repeats are kept.
/// - The rate is 1 / median interval. If the stamps are rounded to more than 1 % of an interval, it
///   is 1 / mean of the intervals within one rounding of the median; if they come in bursts, the
///   long-run rate (time/stamp_steps.hpp).
/// - Stamps that equal k / rate to the last bit are dropped: the base is then uniform.
///
/// Equal to RunningTimeBase with all rows at once, except that the rate is determined from all of
/// them.
[[nodiscard]] TimeBaseFound find_time_base(TimeEvidence evidence, const ReadOptions& options);

}  // namespace proofmass::io
