#pragma once

#include <cstddef>
#include <cstdint>

#include "proofmass/acquire/clock/clock_fit.hpp"
#include "proofmass/acquire/clock/time_line.hpp"
#include "proofmass/acquire/recorder/event.hpp"
#include "proofmass/acquire/recorder/file.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/recording_log.hpp"

namespace proofmass::acquire {

/// Accumulates the summary of a recording.
class RecordTally {
 public:
  /// False: the limit is reached and this event is only counted.
  [[nodiscard]] bool add(const RecordEvent& event);
  /// Rows arrived; the last of them is at the current time of the line.
  void add_arrival(const TimeLine& line, const SourceHead& head, std::int64_t host_ns);
  /// Updates the clock estimate from all arrivals so far.
  void report_clock();
  /// Metadata for the end of a file.
  [[nodiscard]] RecordWords words() const;

  RecordSummary summary{};

 private:
  ClockFit time_fit_;
  ClockFit rows_fit_;
  double nominal_hz_ = 0.0;
};

}  // namespace proofmass::acquire
