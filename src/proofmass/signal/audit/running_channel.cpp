#include "proofmass/signal/audit/running_channel.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/range_limit.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

bool has_range(Quantity quantity) {
  return quantity == Quantity::acceleration || quantity == Quantity::angular_rate ||
         quantity == Quantity::voltage || quantity == Quantity::counts;
}

/// Samples in runs of three or more at a rail, if the signal accumulates there: more often than in
/// the adjacent fiftieth of the range, and in more than one held value.
std::size_t count_clipped(const RailRuns& at,
                          std::size_t longest_elsewhere,
                          double beside,
                          std::optional<double> lsb) {
  if (lsb && !at.is_run_into(*lsb)) return 0;
  const bool is_rail = at.runs >= 2 || at.longest > longest_elsewhere;
  return is_rail && at.rail != 0.0 && static_cast<double>(at.samples) > beside ? at.samples : 0;
}

/// Samples at a rail that noise or vibration reaches for one or two samples at a time, if its value
/// occurs eight times as often as each of those next to it. That of a crest in quantisation steps
/// occurs 2.4 times as often as the next, and a position that is held has long visits.
std::size_t count_piled_up(const RailRuns& at, double most_frequent_beside) {
  constexpr std::size_t fewest = 24, fewest_visits = 12;
  constexpr double times_as_often = 8.0;
  const bool is_brief = at.visits >= fewest_visits && 2 * at.brief_visits >= at.visits;
  const bool is_pile = at.all_samples >= fewest &&
                       static_cast<double>(at.all_samples) >= times_as_often * most_frequent_beside;
  return at.rail != 0.0 && is_brief && is_pile ? at.all_samples : 0;
}

/// Segments of eight samples or more that stay within one quantisation step.
struct Stays {
  std::vector<double> at_rails;  ///< their lengths
  std::vector<double> elsewhere;
};

Stays stays_of(View<double> series, double low, double high, double lsb) {
  constexpr double shortest = 8.0;
  Stays out;
  for (std::size_t from = 0, end = 0; from < series.size(); from = end) {
    double least = series[from], most = series[from];
    for (end = from + 1; end < series.size(); ++end) {
      const double next_least = std::min(least, series[end]),
                   next_most = std::max(most, series[end]);
      if (!(next_most - next_least <= 1.01 * lsb) || std::isnan(series[end])) break;
      least = next_least;
      most = next_most;
    }
    const auto length = static_cast<double>(end - from);
    if (length < shortest) continue;
    const bool is_at_rail = least < low + 0.5 * lsb || most > high - 0.5 * lsb;
    (is_at_rail ? out.at_rails : out.elsewhere).push_back(length);
  }
  return out;
}

/// True if the channel stays at other values, too, for as long as at its extremes, and a third as
/// often: then the motion holds them.
bool holds_other_values(View<double> series, double low, double high, double lsb) {
  const Stays stays = stays_of(series, low, high, lsb);
  const double usual = median(stays.at_rails).value_or(0.0);
  const auto as_long = std::ranges::count_if(
      stays.elsewhere, [usual](double length) { return length >= 0.5 * usual; });
  return static_cast<std::size_t>(as_long) * 3 > stays.at_rails.size();
}

Clipping clipping_of(RangeLimit::Kind kind) {
  switch (kind) {
    case RangeLimit::Kind::hard:
      return Clipping::before_noise;
    case RangeLimit::Kind::soft:
      return Clipping::soft;
    case RangeLimit::Kind::flat:
      break;
  }
  return Clipping::undetermined;
}

/// Limits that are not a single value; if the two sides differ, the clearer one is reported.
void judge_crests(ChannelAudit& audit, const ValueExcerpts& excerpts) {
  const std::vector<double> series = excerpts.values();
  std::optional<RangeLimit> high, low;
  constexpr std::size_t passes = 4;  // of a search for a limit, on average
  run_tasks(passes * series.size(), {[&] { high = find_upper_limit(series); },
                                     [&] {
                                       std::vector<double> turned(series.size());
                                       std::ranges::transform(series, turned.begin(),
                                                              std::negate<>());
                                       low = find_upper_limit(turned);
                                     }});
  if (!high && !low) return;
  const auto kind = std::min(high ? high->kind : RangeLimit::Kind::flat,
                             low ? low->kind : RangeLimit::Kind::flat);
  audit.clipping = clipping_of(kind);
  std::size_t samples = 0;
  if (high && high->kind == kind) {
    audit.limit_high = high->level;
    samples += high->samples;
  }
  if (low && low->kind == kind) {
    audit.limit_low = -low->level;
    samples += low->samples;
  }
  if (audit.clipping == Clipping::undetermined) return;
  audit.clipped =
      static_cast<std::size_t>(std::round(static_cast<double>(samples) * excerpts.share()));
}

void take_plausible(View<double> values, std::vector<double>& out) {
  // Branch-free: odd values are unpredictable.
  out.resize(values.size());
  std::size_t count = 0;
  for (const double value : values) {
    out[count] = value;
    count += is_plausible(value) ? 1 : 0;
  }
  out.resize(count);
}

}  // namespace

RunningChannel::RunningChannel(std::size_t sample_capacity)
    : sample_(sample_capacity),
      lowest_(ClippingTail::Side::lowest, sample_capacity / 32),
      highest_(ClippingTail::Side::highest, sample_capacity / 32),
      excerpts_(sample_capacity / 2) {}

void RunningChannel::add(View<double> values, const SampleTimes& times) {
  const ChunkStatistics figures = chunk_statistics(values);
  if (!figures.plausible) return add_odd(values, times);
  add_plausible(values, figures);
  excerpts_.add(values);
  runs_.add(values, times.first, times, figures.min, figures.max);
}

void RunningChannel::add_to_tails(View<double> values) {
  ChunkStatistics figures = chunk_statistics(values);
  if (!figures.plausible) {
    take_plausible(values, of_tails_);
    if (of_tails_.empty()) return;
    values = of_tails_;
    figures = chunk_statistics(values);
  }
  lowest_.add(values, figures.min);
  highest_.add(values, figures.max);
}

void RunningChannel::add_plausible(View<double> values, const ChunkStatistics& figures) {
  add_chunk(moments_, figures, values);
  sample_.add(values);
}

void RunningChannel::add_odd(View<double> values, const SampleTimes& times) {
  take_plausible(values, plausible_);
  const ChunkStatistics figures =
      plausible_.empty() ? ChunkStatistics{.min = 1.0} : chunk_statistics(plausible_);
  if (!plausible_.empty()) add_plausible(plausible_, figures);
  plausible_.resize(values.size());
  std::ranges::transform(values, plausible_.begin(), plausible_or_nan);
  excerpts_.add(plausible_);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!is_plausible(values[k])) {
      take_odd(values[k], times.at(times.first + k));
      runs_.end_run();
      continue;
    }
    const std::size_t from = k;
    while (k + 1 < values.size() && is_plausible(values[k + 1])) ++k;
    runs_.add(values.subspan(from, k + 1 - from), times.first + from, times, figures.min,
              figures.max);
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

ChannelAudit RunningChannel::finish(const Channel& channel, Limits limits) {
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
  judge_range(out, limits);
  return out;
}

void RunningChannel::judge_range(ChannelAudit& audit, Limits limits) const {
  const double range = moments_.max - moments_.min;
  if (!has_range(audit.unit.quantity) || !(range > 0.0)) return;
  // With only a few levels, the outermost are not rails but the ends of the noise.
  constexpr double fewest_levels = 32.0;
  if (audit.lsb && range < fewest_levels * *audit.lsb) return;
  judge_rails(audit);
  if (limits == Limits::all && audit.clipping == Clipping::none) judge_crests(audit, excerpts_);
}

void RunningChannel::judge_rails(ChannelAudit& audit) const {
  const double nearby = (moments_.max - moments_.min) / 50.0;
  const auto piled_up_at = [&](const RailRuns& rail, const ClippingTail& tail) {
    return count_piled_up(rail, tail.most_frequent_beside(sample_));
  };
  const auto clipped_at = [&](const RailRuns& rail, const ClippingTail& tail) {
    return count_clipped(rail, runs_.longest_elsewhere(), tail.beside(nearby, sample_), audit.lsb);
  };
  std::size_t above = piled_up_at(runs_.high(), highest_);
  std::size_t below = piled_up_at(runs_.low(), lowest_);
  const bool is_certain = above + below > 0;
  if (above == 0) above = clipped_at(runs_.high(), highest_);
  if (below == 0) below = clipped_at(runs_.low(), lowest_);
  if (above + below == 0) return;
  if (!is_certain && audit.lsb &&
      holds_other_values(excerpts_.values(), moments_.min, moments_.max, *audit.lsb))
    return;
  audit.clipping = Clipping::rail;
  audit.clipped = above + below;
  if (above > 0) audit.limit_high = runs_.high().rail;
  if (below > 0) audit.limit_low = runs_.low().rail;
}

}  // namespace proofmass::signal
