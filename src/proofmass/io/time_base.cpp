#include "proofmass/io/time_base.hpp"

#include <utility>

#include "proofmass/io/time/running_time.hpp"

namespace proofmass::io {

TimeBaseFound find_time_base(TimeEvidence evidence, const ReadOptions& options) {
  TimeBaseFound found;
  RunningTimeBase running(evidence, options);
  std::vector<double> times;
  if (running.base_.source == TimeSource::stamps) {
    times = std::move(evidence.stamps->values);
    const bool is_regular = are_regular(times, running.mender_.usual());
    static_cast<void>(running.mender_.fold(times, evidence.counter, true));
    running.update_counts();
    if (!is_regular)
      if (const StampSteps steps = measure_steps(times); steps.is_of_clock())
        running.take_rate(steps);
    running.to_seconds(times);
  } else if (running.base_.source == TimeSource::counter) {
    times.resize(evidence.counter.size());
    static_cast<void>(running.mend(times, evidence.counter, true));
    // No row is missing: the rate is sufficient.
    if (running.counted_.lost() == 0 && running.counted_.restarts() == 0) {
      running.base_.source = TimeSource::given_rate;
      running.base_.channel.clear();
      times.clear();
    }
  }
  found.notes = running.notes();
  found.base = running.base_;
  if (found.base.source == TimeSource::stamps) {
    if (const double rate_hz = uniform_rate_hz(times); rate_hz > 0.0) {
      found.base.rate_hz = rate_hz;
      std::vector<double>().swap(times);
    }
  }
  found.base.stamps_s = std::move(times);
  if (running.is_rejected()) found.rejected = std::move(evidence.stamps);
  return found;
}

}  // namespace proofmass::io
