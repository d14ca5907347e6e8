#pragma once

#include <cstddef>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::signal {

/// Judges the stamps of a recording that come in chunks.
class RunningTiming {
 public:
  /// The nominal rate; 0 if none is known.
  explicit RunningTiming(double rate_hz) : rate_hz_(rate_hz) {}

  void add(View<double> stamps_s);

  /// All of a TimingAudit but what a counter says of lost rows. `time` is the base as known at the
  /// end.
  [[nodiscard]] TimingAudit finish(const TimeBase& time) const;

 private:
  void add_step(double before_s, double step_s);

  double rate_hz_;
  std::size_t stamps_ = 0;
  double last_s_ = 0.0;
  TimingAudit found_;  ///< counts and gaps
  double squares_ = 0.0;
  std::size_t regular_ = 0;
};

}  // namespace proofmass::signal
