#pragma once

#include <optional>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/time_base.hpp"

namespace proofmass::io {

/// Unit of a column of stamps.
struct StampUnit {
  double unit_s = 1.0;
  StampOrigin origin;        ///< origin of the column, counted from 1970 if its values are dates
  bool is_calendar = false;  ///< the stamps are dates or times of day
  std::optional<Note> note;  ///< present if the file does not state the unit
};

/// The unit of stamps with an interval of `step`:
///
/// - the one stated in the file; else
/// - the one for which the first stamp is a date of 2000 … 2060 at a plausible rate, in s, ms, us
///   or ns since 1970, or in days as counted by MATLAB (719529 is 1970) or a spreadsheet (25569);
///   else
/// - of s, ms, us, ns the one whose rate is nearest 100 Hz in ratio.
///
/// Seconds since 1904, as counted by LabVIEW, are recognised by their magnitude in either case.
[[nodiscard]] StampUnit unit_of(const StampColumn& stamps, double step);

}  // namespace proofmass::io
