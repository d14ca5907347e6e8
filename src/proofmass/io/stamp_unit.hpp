#pragma once

#include <optional>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/time_base.hpp"

namespace proofmass::io {

/// What the figures of a column of stamps are in.
struct StampUnit {
  double unit_s = 1.0;
  StampOrigin origin;        ///< of the column, counted from 1970 where its figures are dates
  bool is_calendar = false;  ///< the stamps are dates, or times of day
  std::optional<Note> note;  ///< where the file does not say so itself
};

/// The unit of stamps with a step of `step`: the one the file gives; else the one that makes the
/// first stamp a date of 2000 … 2060 at a plausible rate, in s, ms, us or ns since 1970, in days
/// as MATLAB (719529 is 1970) or a spreadsheet (25569) counts them; else of s, ms, us, ns the one
/// whose rate is nearest 100 Hz in ratio. Seconds since 1904, as LabVIEW counts them, are told by
/// their size in either case.
[[nodiscard]] StampUnit unit_of(const StampColumn& stamps, double step);

}  // namespace proofmass::io
