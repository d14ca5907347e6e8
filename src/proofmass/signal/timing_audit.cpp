#include "proofmass/signal/timing_audit.hpp"

#include <cmath>

#include "proofmass/signal/counter.hpp"

namespace proofmass::signal {
namespace {

void audit_steps(View<double> stamps_s, double nominal_s, TimingAudit& out) {
  double squares = 0.0;
  std::size_t regular = 0;
  for (std::size_t k = 1; k < stamps_s.size(); ++k) {
    const double step_s = stamps_s[k] - stamps_s[k - 1];
    const double deviation_s = step_s - nominal_s;
    if (step_s < 0.0) ++out.backwards;
    if (step_s == 0.0) ++out.repeated;
    if (step_s > 1.5 * nominal_s) out.gaps.push_back({stamps_s[k - 1], step_s});
    if (std::abs(deviation_s) > 0.5 * nominal_s) continue;
    squares += deviation_s * deviation_s;
    ++regular;
  }
  if (regular == 0) return;
  const double jitter_s = std::sqrt(squares / static_cast<double>(regular));
  // Below this it is the rounding of doubles, not of a clock.
  out.jitter_s = jitter_s < 1e-9 * nominal_s ? 0.0 : jitter_s;
}

}  // namespace

TimingAudit audit_timing(const Recording& recording) {
  const TimeBase& time = recording.time;
  TimingAudit out;
  out.source = time.source;
  out.channel = time.channel;
  out.rate_hz = time.rate_hz;
  out.mended = time.mended;
  out.backwards = time.mended_backwards;
  if (!time.is_uniform() && time.rate_hz > 0.0)
    audit_steps(time.stamps_s, 1.0 / time.rate_hz, out);
  else if (time.source == TimeSource::stamps)
    out.jitter_s = 0.0;
  if (const auto counter = find_counter(recording))
    out.lost = count_lost_rows(recording.channels[*counter].values);
  return out;
}

}  // namespace proofmass::signal
