#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/hole_finder.hpp"
#include "proofmass/signal/rate_line.hpp"

namespace proofmass::signal {

/// Judges the stamps of a recording that come in chunks.
class RunningTiming {
 public:
  /// The base without stamps; of a rate of 0 if none is known.
  explicit RunningTiming(const TimeBase& time)
      : rate_hz_(time.rate_hz),
        band_s_(time.rate_hz > 0.0 ? time.band_s : 0.0),
        holes_(time.rate_hz, band_s_) {}

  void add(View<double> stamps_s);

  /// All of a TimingAudit but what a counter says of lost rows. `time` is the base as known at the
  /// end.
  [[nodiscard]] TimingAudit finish(const TimeBase& time);

 private:
  void add_step(double before_s, double step_s);
  void add_gap(const Gap& gap);
  void take_holes();
  void take_numbers();
  [[nodiscard]] std::optional<double> rate_std_hz() const;

  double rate_hz_;
  double band_s_;
  HoleFinder holes_;  ///< for the rate of the long run, and the gaps where there is a band
  std::vector<Hole> fresh_;
  std::vector<double> recent_;  ///< stamps that a hole may still be found among
  RateLine line_;
  std::size_t numbered_ = 0;  ///< stamps in the line
  double next_number_ = 0.0;  ///< of the sample that comes next, missing ones counted
  std::size_t unbroken_ = 0;  ///< samples since the last hole
  std::size_t longest_unbroken_ = 0;
  bool in_whole_steps_ = true;  ///< every step a whole number of nominal ones
  std::size_t stamps_ = 0;
  double last_s_ = 0.0;
  TimingAudit found_;  ///< counts and gaps
  double squares_ = 0.0;
  std::size_t regular_ = 0;
};

}  // namespace proofmass::signal
