#pragma once

#include <cstddef>
#include <cstdint>

#include "proofmass/acquire/clock_fit.hpp"
#include "proofmass/acquire/record_event.hpp"
#include "proofmass/acquire/record_file.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/acquire/time_line.hpp"
#include "proofmass/core/recording_log.hpp"

namespace proofmass::acquire {

/// Puts the account of a recording together while it is made.
class RecordTally {
 public:
  /// False: there have been so many of them that this one is only counted.
  [[nodiscard]] bool add(const RecordEvent& event);
  /// Rows arrived; the last of them is where the time line is.
  void add_arrival(const TimeLine& line, const SourceHead& head, std::int64_t host_ns);
  /// The clock as told by all arrivals so far.
  void tell_clock();
  /// What a file says at its end.
  [[nodiscard]] RecordWords words() const;

  RecordSummary summary{};

 private:
  ClockFit time_fit_;
  ClockFit rows_fit_;
  double nominal_hz_ = 0.0;
};

}  // namespace proofmass::acquire
