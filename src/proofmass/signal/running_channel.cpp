#include "proofmass/signal/running_channel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

bool has_range(Quantity quantity) {
  return quantity == Quantity::acceleration || quantity == Quantity::angular_rate ||
         quantity == Quantity::voltage || quantity == Quantity::counts;
}

/// Samples in runs of three or more at a rail, if the signal piles up there: more often than in the
/// fiftieth of the range beside it, and not just for once as a value that is held is.
std::size_t count_clipped(const RailRuns& at,
                          std::size_t longest_elsewhere,
                          double beside,
                          std::optional<double> lsb) {
  if (lsb && !at.is_run_into(*lsb)) return 0;
  const bool is_rail = at.runs >= 2 || at.longest > longest_elsewhere;
  return is_rail && at.rail != 0.0 && static_cast<double>(at.samples) > beside ? at.samples : 0;
}

}  // namespace

RunningChannel::RunningChannel(std::size_t sample_capacity)
    : sample_(sample_capacity),
      lowest_(ValueTail::Side::lowest, sample_capacity / 32),
      highest_(ValueTail::Side::highest, sample_capacity / 32) {}

void RunningChannel::add(View<double> values, const SampleTimes& times) {
  last_ = chunk_figures(values);
  if (!last_.plausible) return add_odd(values, times);
  add_plausible(values);
  runs_.add(values, times.first, times, last_.min, last_.max);
}

// All but the runs.
void RunningChannel::add_plausible(View<double> values) {
  add_chunk(moments_, last_, values);
  sample_.add(values);
  lowest_.add(values, last_.min);
  highest_.add(values, last_.max);
}

void RunningChannel::add_odd(View<double> values, const SampleTimes& times) {
  // Without a branch: which values are odd, nobody can guess.
  plausible_.resize(values.size());
  std::size_t count = 0;
  for (const double value : values) {
    plausible_[count] = value;
    count += is_plausible(value) ? 1 : 0;
  }
  plausible_.resize(count);
  last_ = plausible_.empty() ? ChunkFigures{.min = 1.0} : chunk_figures(plausible_);
  if (!plausible_.empty()) add_plausible(plausible_);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!is_plausible(values[k])) {
      take_odd(values[k], times.at(times.first + k));
      runs_.end_run();
      continue;
    }
    const std::size_t from = k;
    while (k + 1 < values.size() && is_plausible(values[k + 1])) ++k;
    runs_.add(values.subspan(from, k + 1 - from), times.first + from, times, last_.min, last_.max);
  }
}

void RunningChannel::take_odd(double value, Place place) {
  if (std::isnan(value))
    nan_.add(place);
  else if (std::isinf(value))
    infinite_.add(place);
  else if (std::abs(value) > absurd_magnitude)
    absurd_.add(place);
  else
    denormal_.add(place);
}

ChannelAudit RunningChannel::finish(const Channel& channel) {
  runs_.end_run();
  ChannelAudit out;
  out.name = channel.name;
  out.unit = channel.unit;
  out.moments = moments_;
  out.nonfinite = nan_.count + infinite_.count;
  out.infinite = infinite_.count;
  out.absurd = absurd_.count;
  out.denormal = denormal_.count;
  out.longest_stuck = runs_.longest();
  out.longest_stuck_start_s = runs_.longest_start().s;
  const View<double> sample = sample_.values();
  out.lsb = find_lsb_of_plausible({sample.begin(), sample.end()});
  out.clipped = clipped(out, channel.unit.quantity);
  return out;
}

std::size_t RunningChannel::clipped(const ChannelAudit& audit, Quantity quantity) const {
  const double range = moments_.max - moments_.min;
  if (!has_range(quantity) || !(range > 0.0)) return 0;
  // Of a handful of levels the outermost are no rails, only the ends of the noise.
  constexpr double fewest_levels = 32.0;
  if (audit.lsb && range < fewest_levels * *audit.lsb) return 0;
  const double nearby = range / 50.0;
  return count_clipped(runs_.high(), runs_.longest_but_high(), highest_.beside(nearby, sample_),
                       audit.lsb) +
         count_clipped(runs_.low(), runs_.longest_but_low(), lowest_.beside(nearby, sample_),
                       audit.lsb);
}

}  // namespace proofmass::signal
