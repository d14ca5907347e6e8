#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/audit/rate_line.hpp"
#include "proofmass/signal/resample/hole_finder.hpp"

namespace proofmass::signal {

/// Audits the stamps of a recording in chunks.
class RunningTiming {
 public:
  /// The time base without stamps; its rate is 0 if unknown.
  explicit RunningTiming(const TimeBase& time)
      : rate_hz_(time.rate_hz),
        band_s_(time.rate_hz > 0.0 ? time.band_s : 0.0),
        holes_(time.rate_hz, band_s_) {}

  void add(View<double> stamps_s);

  /// A TimingAudit without the rows that a counter reports as lost. `time` is the base as known at
  /// the end.
  [[nodiscard]] TimingAudit finish(const TimeBase& time);

 private:
  void add_step(double step_s);
  [[nodiscard]] Gap gap_at(const Hole& hole) const;
  void add_gap(const Gap& gap);
  void take_holes();
  void take_numbers();
  void note_stall(double before_s, double stamp_s);
  void take_rate(TimingAudit& out) const;

  double rate_hz_;
  double band_s_;
  HoleFinder holes_;  ///< for the long-run rate, and for the gaps if there is a band
  std::vector<Hole> fresh_;
  std::vector<double> recent_;  ///< stamps among which a hole may still be found
  RateLine line_;
  std::size_t numbered_ = 0;  ///< stamps in the fitted line
  double next_number_ = 0.0;  ///< number of the next sample, missing ones counted
  std::size_t unbroken_ = 0;  ///< samples since the last hole
  std::size_t longest_unbroken_ = 0;
  bool in_whole_steps_ = true;  ///< every interval is a whole number of nominal periods
  std::size_t stamps_ = 0;
  double first_s_ = 0.0, last_s_ = 0.0;
  TimingAudit found_;  ///< counts and gaps
  double squares_ = 0.0;
  std::size_t regular_ = 0;
};

}  // namespace proofmass::signal
