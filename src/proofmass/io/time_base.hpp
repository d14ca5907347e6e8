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

/// A column of stamps as a reader found it.
struct StampColumn {
  std::string name;
  Unit unit;                   ///< Quantity::unknown: told by the size of the figures
  StampOrigin origin;          ///< exact first stamp
  std::vector<double> values;  ///< stamps less the origin, in `unit`; NaN where there is none
  bool is_named = true;        ///< false: only its ascending says that it is a time
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
/// Stamps: the unit from the header, else the one that makes an epoch of the first stamp at a
/// plausible rate, else the one whose rate is nearest 100 Hz; a counter that ran over (2^16, 2^24,
/// 2^31, 2^32) is unrolled; stamps that are no number, or lie apart from those before and after
/// them, are put where the instrument's counter says, or evenly between their good neighbours.
/// Stamps that repeat or go back for good are kept. The rate is 1 / median step; where the
/// stamps are rounded to more than 1 % of a step, 1 / mean of the steps within one rounding of the
/// median. Stamps that are k / rate to the last bit are dropped: the base is uniform then.
[[nodiscard]] TimeBaseFound find_time_base(TimeEvidence evidence, const ReadOptions& options);

}  // namespace proofmass::io
