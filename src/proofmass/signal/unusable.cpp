#include "proofmass/signal/unusable.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/extreme_levels.hpp"
#include "proofmass/signal/audit/running_channel.hpp"
#include "proofmass/signal/audit/stuck_values.hpp"
#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/rests.hpp"

namespace proofmass::signal {
namespace {

struct Run {
  std::size_t first = 0, end = 0;
  [[nodiscard]] std::size_t size() const { return end - first; }
};

std::vector<Run> runs_at(View<double> series, double value) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < series.size(); ++k) {
    Run run{k, k};
    while (run.end < series.size() && series[run.end] == value) ++run.end;
    if (run.size() >= RailRuns::shortest_run) runs.push_back(run);
    k = std::max(k, run.end);
  }
  return runs;
}

// Whether a quarter of the runs' sides, two at least, are too steep for a crest.
bool are_cut_off(View<double> series, const std::vector<Run>& runs, double value, double lsb) {
  std::size_t steep = 0, sides = 0;
  const auto add = [&](const Run& run, double nearer, double farther) {
    const double towards = nearer < value ? 1.0 : -1.0;
    const double step = std::min(towards * (value - nearer), towards * (nearer - farther));
    ++sides;
    if (is_cut_off(run.size(), step, lsb)) ++steep;
  };
  for (const Run& run : runs) {
    if (run.first >= 2) add(run, series[run.first - 1], series[run.first - 2]);
    if (run.end + 1 < series.size()) add(run, series[run.end], series[run.end + 1]);
  }
  return steep >= 2 && 4 * steep >= sides;
}

// An axis whose changes show that the body moves.
class Witness {
 public:
  explicit Witness(View<double> series) : series_(series) {
    std::vector<double> bends;  // of which even a fast motion has few
    for (std::size_t k = 2; k < series.size(); ++k)
      bends.push_back(series[k] - 2.0 * series[k - 1] + series[k - 2]);
    std::erase_if(bends, [](double bend) { return !std::isfinite(bend); });
    constexpr double steps = 3.0, noises = 8.0;
    const double noise = robust_std(bends).value_or(0.0) / std::sqrt(6.0);
    still_ = steps * find_lsb(series).value_or(0.0) + noises * noise;
  }
  [[nodiscard]] bool moves(const Run& run) const {
    Moments values;
    for (std::size_t k = run.first; k < run.end; ++k)
      if (is_plausible(series_[k])) values.add(series_[k]);
    return values.count > 1 && values.max - values.min > still_;
  }

 private:
  View<double> series_;
  double still_ = 0.0;
};

bool most_move(const std::vector<Run>& runs, const std::vector<Witness>& witnesses) {
  std::size_t moving = 0, all = 0;
  for (const Run& run : runs) {
    all += run.size();
    if (std::ranges::any_of(witnesses, [&](const Witness& one) { return one.moves(run); }))
      moving += run.size();
  }
  return 2 * moving > all;
}

// Whether the values change from sample to sample but in these runs, which are long, and not where
// the axis is for most of the time.
bool stand_out(View<double> series, const std::vector<Run>& runs, double low, double high) {
  constexpr std::size_t shortest = 8, times_as_long = 4;
  std::size_t at_ends = 0, run = 0, longest = 0, in_runs = 0, in_long = 0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const bool at_end = series[k] == low || series[k] == high;
    at_ends += at_end ? 1 : 0;
    run = at_end ? 0 : (k > 0 && series[k] == series[k - 1] ? run + 1 : 1);
    longest = std::max(longest, run);
  }
  for (const Run& one : runs) {
    in_runs += one.size();
    if (one.size() >= std::max(shortest, times_as_long * longest)) in_long += one.size();
  }
  return 2 * at_ends < series.size() && 2 * in_long > in_runs;
}

// The end of the range of values and the eight levels nearest to it.
ExtremeLevels levels_at(View<double> series, double end) {
  std::vector<double> off;
  for (const double value : series)
    if (is_plausible(value)) off.push_back(std::abs(value - end));
  return levels_at_lowest(std::move(off));
}

// Whether noise of two quantisation steps or more leaves the lowest or highest value eight times as
// often as each of the levels next to it, while another axis changes: the noise of a sensor at rest
// near its limit is cut off there, in runs too short and too irregular for the other tests.
bool piles_up(View<double> series, double end, const std::vector<View<double>>& others) {
  constexpr std::size_t fewest = 50, times_as_often = 8;
  constexpr double steps = 2.0;
  std::vector<double> changes;
  std::size_t stays = 0, alone = 0;
  for (std::size_t k = 1; k < series.size(); ++k) {
    const double change = std::abs(series[k] - series[k - 1]);
    if (series[k] != end || change != 0.0) {
      if (std::isfinite(change)) changes.push_back(change);
      continue;
    }
    ++stays;
    if (std::ranges::any_of(others, [k](View<double> o) { return o[k] != o[k - 1]; })) ++alone;
  }
  if (stays < fewest || 2 * alone < stays) return false;
  const ExtremeLevels levels = levels_at(series, end);
  return levels.at_extreme >= times_as_often * levels.most_frequent &&
         median(std::move(changes)).value_or(0.0) >= steps * levels.step && levels.step > 0.0;
}

ChannelAudit rails_of(const Channel& axis) {
  RunningChannel running(Subsample::usual_capacity);
  const View<double> values = axis.values;
  for (std::size_t from = 0; from < values.size(); from += ValueExcerpts::piece) {
    const View<double> piece =
        values.subspan(from, std::min(ValueExcerpts::piece, values.size() - from));
    running.add(piece, SampleTimes{.first = from, .stamps_s = {}});
    running.add_to_tails(piece);
  }
  Unit of_a_sensor = axis.unit;
  of_a_sensor.quantity = Quantity::counts;
  return running.finish({axis.name, of_a_sensor, {}}, RunningChannel::Limits::rails);
}

// Rails but the level at rest.
RangeEnds far_rails(const ChannelAudit& found, View<double> series) {
  RangeEnds ends{found.limit_low, found.limit_high};
  if (!ends.reached()) return ends;
  constexpr double of_magnitude = 0.5, of_range = 0.2;
  std::vector<double> plausible(series.begin(), series.end());
  std::erase_if(plausible, [](double value) { return !is_plausible(value); });
  const double middle = *median(std::move(plausible));
  const Moments& all = found.moments;
  const double largest = std::max(std::abs(all.min), std::abs(all.max));
  for (std::optional<double>* end : {&ends.low, &ends.high})
    if (*end && std::abs(**end) < of_magnitude * largest &&
        std::abs(**end - middle) < of_range * (all.max - all.min))
      end->reset();
  return ends;
}

std::string in_words(const RangeEnds& ends, const Unit& unit) {
  std::string values;
  for (const std::optional<double>& end : {ends.low, ends.high})
    if (end) values += fmt::format("{}{:.5g}", values.empty() ? "" : " and ", *end);
  return values + (unit.symbol.empty() ? "" : " " + unit.symbol);
}

}  // namespace

RangeEnds range_ends(const Channel& axis, const std::vector<View<double>>& others) {
  const View<double> series = axis.values;
  const ChannelAudit found = rails_of(axis);
  RangeEnds ends = far_rails(found, series);
  const double low = found.moments.min, high = found.moments.max;
  constexpr double fewest_levels = 32.0;  // fewer are the ends of noise
  const double lsb = found.lsb.value_or(0.0);
  if (!(low < high) || high - low < fewest_levels * lsb) return ends;
  std::vector<Witness> witnesses;
  for (const auto& [value, end] : {std::pair{low, &ends.low}, {high, &ends.high}}) {
    if (*end) continue;
    if (lsb > 0.0 && piles_up(series, value, others)) {
      *end = value;
      continue;
    }
    const std::vector<Run> runs = runs_at(series, value);
    if (!are_cut_off(series, runs, value, lsb)) continue;
    if (witnesses.empty())
      for (const View<double> other : others) witnesses.emplace_back(other);
    if (most_move(runs, witnesses) || stand_out(series, runs, low, high)) *end = value;
  }
  return ends;
}

namespace {

// The samples at an end of the channel's range, and what is said about them.
struct Saturated {
  std::vector<std::size_t> samples;
  std::string ends;
};

// Channels that change when one does: those beside it, and the witnesses.
std::vector<View<double>> beside(std::size_t channel,
                                 std::vector<std::size_t> channels,
                                 const std::vector<std::size_t>& witnesses,
                                 const Recording& recording) {
  std::erase(channels, channel);
  channels.insert(channels.end(), witnesses.begin(), witnesses.end());
  std::vector<View<double>> out;
  for (const std::size_t other : channels) out.emplace_back(recording.channels[other].values);
  return out;
}

std::vector<Saturated> saturated(const std::vector<std::size_t>& channels,
                                 const Recording& recording,
                                 const std::vector<std::size_t>& witnesses = {}) {
  std::vector<Saturated> out;
  for (const std::size_t c : channels) {
    const Channel& channel = recording.channels[c];
    const RangeEnds ends = range_ends(channel, beside(c, channels, witnesses, recording));
    Saturated& one = out.emplace_back();
    if (!ends.reached()) continue;
    one.ends = in_words(ends, channel.unit);
    const View<double> values = channel.values;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (values[k] == ends.low || values[k] == ends.high) one.samples.push_back(k);
  }
  return out;
}

Note note_on(const Saturated& found, const Channel& channel, const Recording& recording) {
  return {Severity::warning,
          fmt::format("{}: {} of {} samples are at the limits of the range ({}), from {:.2f} s on, "
                      "and are not used: record with a wider range",
                      channel.name, found.samples.size(), channel.values.size(), found.ends,
                      recording.time.at(found.samples.front()))};
}

}  // namespace

std::vector<Note> drop_saturated(const std::vector<std::size_t>& channels,
                                 Recording& recording,
                                 const std::vector<std::size_t>& witnesses) {
  const std::vector<Saturated> found = saturated(channels, recording, witnesses);
  std::vector<Note> notes;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (found[i].samples.empty()) continue;
    Channel& channel = recording.channels[channels[i]];
    std::vector<double>& values = channel.values.edit();
    for (const std::size_t k : found[i].samples) values[k] = no_value;
    notes.push_back(note_on(found[i], channel, recording));
  }
  return notes;
}

std::vector<Note> drop_saturated_rests(const std::vector<std::size_t>& channels,
                                       Recording& recording) {
  constexpr double around_s = 0.5, usual_rate_hz = 100.0;
  const double rate_hz = recording.time.rate_hz > 0.0 ? recording.time.rate_hz : usual_rate_hz;
  const auto around = static_cast<std::size_t>(std::ceil(around_s * rate_hz));
  const std::vector<Saturated> found = saturated(channels, recording);
  std::vector<Note> notes;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (found[i].samples.size() < around) continue;
    Channel& channel = recording.channels[channels[i]];
    std::vector<double>& values = channel.values.edit();
    std::size_t next = 0;
    for (const std::size_t k : found[i].samples)
      for (next = std::max(next, k - std::min(k, around));
           next < std::min(values.size(), k + around + 1); ++next)
        values[next] = no_value;
    notes.push_back(note_on(found[i], channel, recording));
  }
  return notes;
}

namespace {

std::vector<View<double>> axes_of(const std::vector<std::size_t>& channels,
                                  const Recording& recording) {
  std::vector<View<double>> axes;
  for (const std::size_t c : channels) axes.emplace_back(recording.channels[c].values);
  return axes;
}

bool are_constant(const std::vector<View<double>>& axes, const Rest& over) {
  return std::ranges::all_of(axes, [&](View<double> axis) {
    const View<double> part = axis.subspan(over.first, over.last - over.first + 1);
    return std::ranges::all_of(part, [&](double value) { return value == part.front(); });
  });
}

Note note_stuck(const std::vector<std::size_t>& channels,
                const std::vector<Rest>& stuck,
                const Recording& recording) {
  std::size_t count = 0;
  for (const Rest& one : stuck) count += one.last - one.first;
  return {
      Severity::warning,
      fmt::format("{} one value in {} of {} samples, from {:.2f} s on, which are not used",
                  recording.channels[channels.front()].name +
                      (channels.size() > 1 ? " and the sensor's other axes repeat" : " repeats"),
                  count, recording.samples(), recording.time.at(stuck.front().first))};
}

}  // namespace

std::vector<Note> drop_stuck(const std::vector<std::vector<std::size_t>>& sensors,
                             Recording& recording) {
  std::vector<std::vector<Rest>> own;
  for (const auto& channels : sensors)
    own.push_back(
        stuck_intervals(axes_of(channels, recording), {.rate_hz = recording.time.rate_hz}));
  std::vector<std::vector<Rest>> all = own;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    for (std::size_t other = 0; other < sensors.size(); ++other)
      if (other != i && own[i].empty())
        std::ranges::copy_if(own[other], std::back_inserter(all[i]), [&](const Rest& one) {
          return are_constant(axes_of(sensors[i], recording), one);
        });
  std::vector<Note> notes;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (all[i].empty()) continue;
    notes.push_back(note_stuck(sensors[i], all[i], recording));
    for (const std::size_t c : sensors[i]) {
      std::vector<double>& values = recording.channels[c].values.edit();
      for (const Rest& one : all[i])
        std::fill(values.begin() + static_cast<std::ptrdiff_t>(one.first) + 1,
                  values.begin() + static_cast<std::ptrdiff_t>(one.last) + 1, no_value);
    }
  }
  return notes;
}

}  // namespace proofmass::signal
