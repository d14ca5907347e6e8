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

/// What the figures of a column of stamps were before they were figures.
enum class StampClock {
  figures,  ///< figures
  wall,     ///< dates or times of day without a zone: summer time may begin or end in it
  zoned,    ///< with a zone
};

/// A column of stamps as a reader found it.
struct StampColumn {
  std::string name;
  Unit unit;                   ///< Quantity::unknown: told by the size of the figures
  StampOrigin origin;          ///< exact first stamp
  std::vector<double> values;  ///< stamps less the origin, in `unit`; NaN where there is none
  bool is_named = true;        ///< false: only its ascending says that it is a time
  StampClock clock = StampClock::figures;
};

/// All that a file says about when its samples were taken.
struct TimeEvidence {
  std::optional<StampColumn> stamps;
  std::string counter_name;              ///< empty if there is no counter
  View<double> counter;                  ///< sample counter of the instrument
  std::optional<double> header_rate_hz;  ///< a rate in the file's preamble
  std::size_t samples = 0;
  std::size_t first_line = 0;  ///< as in Recording
};

struct TimeBaseFound {
  TimeBase base;
  std::vector<Note> notes;
  /// The column of stamps given back where it turned out to be no time base.
  std::optional<StampColumn> rejected;
};

/// Decides on the time base: --rate before stamps, stamps before a rate in the preamble.
/// Stamps: the unit from the header, else by their size (stamp_unit.hpp). What ran over is unrolled
/// and what is no time is mended (stamps.hpp); gaps and repeats are kept. The rate is 1 / median
/// step; where the stamps are rounded to more than 1 % of a step, 1 / mean of the steps within one
/// rounding of the median; where they come in bursts, that of the long run (stamp_steps.hpp).
/// Stamps that are k / rate to the last bit are dropped: the base is uniform then.
/// The same as RunningTimeBase with all rows at once, but that the rate is by all of them.
[[nodiscard]] TimeBaseFound find_time_base(TimeEvidence evidence, const ReadOptions& options);

}  // namespace proofmass::io
