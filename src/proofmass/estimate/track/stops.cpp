#include "proofmass/estimate/track/stops.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

// Means and scatter of the axes over blocks of samples.
struct Blocks {
  std::size_t length = 0;
  std::vector<double> scatter;  // root of the sum over axes; NaN without measurements
  std::vector<std::array<double, 3>> mean;
};

Blocks blocks_of(View<View<double>> axes, std::size_t length) {
  Blocks out{length, {}, {}};
  for (std::size_t first = 0; first + length <= axes[0].size(); first += length) {
    double scatter = 0.0;
    std::array<double, 3> means{};
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const Moments m = moments(axes[a].subspan(first, length));
      scatter += m.count > length / 2 ? m.std() * m.std() : std::nan("");
      means[a] = m.mean;
    }
    out.scatter.push_back(std::sqrt(scatter));
    out.mean.push_back(means);
  }
  return out;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

signal::Rest span_to_rest(const TimeSpan& span, View<double> time_s) {
  const auto first = std::lower_bound(time_s.begin(), time_s.end(), span.start_s);
  const auto after = std::upper_bound(first, time_s.end(), span.end_s);
  return {static_cast<std::size_t>(first - time_s.begin()),
          static_cast<std::size_t>(after - time_s.begin()) - 1};
}

std::vector<signal::Rest> united(std::vector<signal::Rest> rests) {
  std::sort(rests.begin(), rests.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<signal::Rest> out;
  for (const signal::Rest& rest : rests) {
    if (!out.empty() && rest.first <= out.back().last + 1)
      out.back().last = std::max(out.back().last, rest.last);
    else
      out.push_back(rest);
  }
  return out;
}

// Slow motion is seen in longer means: units of one, two and four blocks.
constexpr std::array<std::size_t, 3> units{1, 2, 4};

// Means of the axes over blocks of a quarter of a second of each rest, NaN for a block without
// measurements, and the scatter of the means of a unit at rest.
struct RestMeans {
  std::size_t length = 0;  // of a block, in samples
  std::vector<std::vector<std::array<double, 3>>> of_rest;
  std::array<std::array<double, 3>, units.size()> unit_std{};
  std::array<double, 3> std{};  // of a block
};

constexpr double far_level = 5.0;         // standard deviations of a unit's mean
constexpr std::size_t spread_blocks = 8;  // over which a scatter is taken

double mean_of(View<double> part) {
  const Moments found = moments(part);
  return found.count > 0 ? found.mean : std::numeric_limits<double>::quiet_NaN();
}

// Mean of blocks [first, end), one axis.
Moments over(const std::vector<std::array<double, 3>>& means,
             std::size_t first,
             std::size_t end,
             std::size_t axis) {
  Moments found;
  for (std::size_t k = first; k < end; ++k) found.add(means[k][axis]);
  return found;
}

// Standard deviation of the means of each run of spread_blocks blocks, one axis.
void add_spreads(const std::vector<std::array<double, 3>>& means,
                 std::size_t axis,
                 std::vector<double>& spreads) {
  for (std::size_t i = 0; i + spread_blocks <= means.size(); ++i) {
    const Moments spread = over(means, i, i + spread_blocks, axis);
    if (spread.count == spread_blocks) spreads.push_back(spread.std());
  }
}

// Scatter of the means of blocks at rest, one axis. The fiftieth with the smallest scatter is at
// rest, if anything is; selection makes its scatter smaller than that of all rests.
double steadiest_std(const RestMeans& found, std::size_t axis) {
  constexpr double share = 0.02, dof = spread_blocks - 1.0;
  std::vector<double> spreads;
  for (const auto& means : found.of_rest) add_spreads(means, axis, spreads);
  return quantile(spreads, share).value_or(0.0) / std::sqrt(chi_square_quantile(share, dof) / dof);
}

// Scatter of the means of longer units, one axis: from the smallest tenth of the differences of
// units that follow each other, since most of the others may be motion.
double usual_std(const RestMeans& found, std::size_t axis, std::size_t unit) {
  constexpr double share = 0.1, normal_quantile = 0.1257;  // of the magnitude
  std::vector<double> apart;
  for (const auto& means : found.of_rest)
    for (std::size_t i = 0; i + 2 * unit <= means.size(); ++i) {
      const Moments one = over(means, i, i + unit, axis);
      const Moments next = over(means, i + unit, i + 2 * unit, axis);
      if (one.count == unit && next.count == unit) apart.push_back(std::abs(next.mean - one.mean));
    }
  return quantile(apart, share).value_or(0.0) / (normal_quantile * std::numbers::sqrt2);
}

// Standard deviation of a block's mean from white noise alone: from differences, which a slow
// motion does not affect.
double white_std(View<double> axis, const std::vector<signal::Rest>& rests, std::size_t length) {
  Moments squares;
  for (const signal::Rest& rest : rests)
    for (std::size_t k = rest.first + 1; k <= rest.last; ++k)
      squares.add(0.5 * (axis[k] - axis[k - 1]) * (axis[k] - axis[k - 1]));
  return std::sqrt(squares.mean / static_cast<double>(length));
}

RestMeans rest_means(View<View<double>> axes,
                     const std::vector<signal::Rest>& rests,
                     double rate_hz) {
  RestMeans out;
  out.length = std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(0.25 * rate_hz)));
  for (const signal::Rest& rest : rests) {
    auto& means = out.of_rest.emplace_back();
    for (std::size_t k = rest.first; k + out.length <= rest.last + 1; k += out.length) {
      auto& mean = means.emplace_back();
      for (std::size_t a = 0; a < axes.size(); ++a)
        mean[a] = mean_of(axes[a].subspan(k, out.length));
    }
  }
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const double white = white_std(axes[a], rests, out.length);
    out.unit_std[0][a] = std::max(steadiest_std(out, a), white);
    for (std::size_t u = 1; u < units.size(); ++u)
      out.unit_std[u][a] =
          std::max(usual_std(out, a, units[u]), white / std::sqrt(static_cast<double>(units[u])));
  }
  out.std = out.unit_std[0];
  return out;
}

struct Unit {
  std::size_t blocks = 1;
  std::array<double, 3> std{};  // of its mean
};

// Whether the unit that ends before block `end` departs from the level of the blocks from `from`
// on.
bool departs(const std::vector<std::array<double, 3>>& means,
             std::size_t from,
             std::size_t end,
             const Unit& unit) {
  if (end < from + unit.blocks + 1) return false;
  const std::size_t begin = end - unit.blocks;
  for (std::size_t a = 0; a < 3; ++a) {
    const Moments before = over(means, from, begin, a), now = over(means, begin, end, a);
    if (before.count == 0 || now.count == 0) continue;
    const auto units_of = [&](const Moments& mean) {
      return static_cast<double>(mean.count) / static_cast<double>(unit.blocks);
    };
    const double std = unit.std[a] * std::sqrt(1.0 / units_of(now) + 1.0 / units_of(before));
    if (std::abs(now.mean - before.mean) > far_level * std) return true;
  }
  return false;
}

// Runs of blocks whose level stays near that just before, as [first, end).
std::vector<std::array<std::size_t, 2>> steady_runs(const std::vector<std::array<double, 3>>& means,
                                                    std::size_t reach,
                                                    const RestMeans& found) {
  std::vector<std::array<std::size_t, 2>> runs;
  std::size_t first = 0;
  for (std::size_t end = 1; end <= means.size(); ++end) {
    for (std::size_t u = 0; u < units.size(); ++u) {
      const std::size_t before = std::min(end, units[u] + reach);
      if (!departs(means, std::max(first, end - before), end, {units[u], found.unit_std[u]}))
        continue;
      runs.push_back({first, end - units[u]});
      first = end - units[u];
      break;
    }
  }
  if (!means.empty()) runs.push_back({first, means.size()});
  return runs;
}

// A stretch of a rest whose level stays.
struct SteadyPart {
  std::size_t rest = 0;            // of which it is a part
  std::size_t first = 0, end = 0;  // blocks of it
  std::array<double, 3> level{};
  [[nodiscard]] std::size_t size() const { return end - first; }
};

std::vector<SteadyPart> parts_of(const RestMeans& found, std::size_t rest) {
  std::vector<SteadyPart> parts;
  const auto& means = found.of_rest[rest];
  // A level may drift from two seconds to the next. Where it departs the sensor moves, and what may
  // be drift beside that is slow motion: then it is compared with the minute before.
  constexpr std::size_t minute_blocks = 240;
  auto runs = steady_runs(means, spread_blocks, found);
  if (runs.size() > 1) runs = steady_runs(means, minute_blocks, found);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    // A block next to a departure may contain the beginning or end of the motion.
    SteadyPart part{rest, runs[r][0] + (r == 0 ? 0 : 1),
                    runs[r][1] - (r + 1 == runs.size() ? 0 : 1)};
    if (part.end <= part.first) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      Moments level;
      for (std::size_t k = part.first; k < part.end; ++k) level.add(means[k][a]);
      part.level[a] = level.mean;
    }
    parts.push_back(part);
  }
  return parts;
}

bool same_level(const SteadyPart& one, const SteadyPart& other, const std::array<double, 3>& std) {
  for (std::size_t a = 0; a < 3; ++a)
    if (std::abs(one.level[a] - other.level[a]) > far_level * std[a]) return false;
  return true;
}

// Keeps the parts of a rest at the level of most blocks of `near`, the rests around it: the others
// are motion at temporarily constant acceleration.
void keep_usual_level(std::span<const SteadyPart> near,
                      const std::array<double, 3>& std,
                      std::vector<SteadyPart>& parts) {
  const SteadyPart* usual = nullptr;
  std::size_t most = 0;
  for (const SteadyPart& part : parts) {
    std::size_t blocks = 0;
    for (const SteadyPart& other : near)
      if (same_level(part, other, std)) blocks += other.size();
    if (blocks > most) usual = &part;
    most = std::max(most, blocks);
  }
  if (usual == nullptr) return;
  std::erase_if(parts, [level = *usual, &std](const SteadyPart& part) {
    return !same_level(part, level, std);
  });
}

// Whether the block at one end of a rest departs from the neighbouring two seconds.
bool end_departs(View<View<double>> axes,
                 const RestMeans& found,
                 const signal::Rest& end,
                 const signal::Rest& beside) {
  constexpr double far = 2.5;
  const auto count = static_cast<double>(beside.last - beside.first + 1);
  const double share = static_cast<double>(found.length) / count;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto mean = [&](const signal::Rest& part) {
      return mean_of(axes[a].subspan(part.first, part.last - part.first + 1));
    };
    if (std::abs(mean(end) - mean(beside)) > far * found.std[a] * std::sqrt(1.0 + share))
      return true;
  }
  return false;
}

// Next to motion a rest ends where the motion becomes visible, a block at a time: a non-zero
// velocity there is that of the whole motion.
signal::Rest without_visible_onset(View<View<double>> axes,
                                   const RestMeans& found,
                                   signal::Rest rest) {
  const std::size_t length = found.length, reach = spread_blocks * length;
  const auto is_long = [&] { return rest.last - rest.first + 1 >= 4 * length; };
  while (rest.last + 1 < axes[0].size() && is_long()) {
    const std::size_t from = rest.last + 1 - length;
    const signal::Rest beside{std::max(rest.first, from - std::min(from, reach)), from - 1};
    if (!end_departs(axes, found, {from, rest.last}, beside)) break;
    rest.last = from - 1;
  }
  while (rest.first > 0 && is_long()) {
    const std::size_t to = rest.first + length;
    const signal::Rest beside{to, std::min(rest.last, to + reach - 1)};
    if (!end_departs(axes, found, {rest.first, to - 1}, beside)) break;
    rest.first = to;
  }
  return rest;
}

// How many samples of a motion it takes until its velocity exceeds ten times that of the noise of a
// block, in any axis; a block at most, and 0 if the recording ends before. The motion is samples
// after(0), after(1), … of an axis, in either direction of time.
template <class After>
std::size_t samples_until_moving(View<View<double>> axes,
                                 const RestMeans& found,
                                 const signal::Rest& rest,
                                 std::size_t available,
                                 After after) {
  constexpr double far = 10.0;
  std::size_t until = std::min(available, found.length);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const double level = mean_of(axes[a].subspan(rest.first, rest.last - rest.first + 1));
    const double limit = far * found.std[a] * static_cast<double>(found.length);
    double sum = 0.0;
    for (std::size_t i = 0; i < until; ++i) {
      const double value = axes[a][after(i)];
      if (std::isfinite(value)) sum += value - level;
      if (std::abs(sum) > limit) until = i;
    }
  }
  return until < available || until == found.length ? until : 0;
}

// A motion that begins slowly is hidden in the noise at first: with a quadratic rise, for about as
// long as it then takes to reach several times its velocity. A rest that includes this would have
// velocity 0 where the sensor moves.
signal::Rest without_onset(View<View<double>> axes, const RestMeans& found, signal::Rest rest) {
  rest = without_visible_onset(axes, found, rest);
  const std::size_t length = found.length, count = rest.last - rest.first + 1;
  const std::size_t reach = spread_blocks * length, resolved = length / 4;  // of find_rests()
  const auto hidden = [&](std::size_t until) {
    return std::min(count / 3, until - std::min(until, resolved));
  };
  signal::Rest kept = rest;
  if (const std::size_t after = axes[0].size() - 1 - rest.last; after > 0) {
    const signal::Rest end{std::max(rest.first, rest.last - std::min(rest.last, reach)), rest.last};
    kept.last -= hidden(samples_until_moving(axes, found, end, after,
                                             [&](std::size_t i) { return rest.last + 1 + i; }));
  }
  if (rest.first > 0) {
    const signal::Rest begin{rest.first, std::min(rest.last, rest.first + reach)};
    kept.first += hidden(samples_until_moving(axes, found, begin, rest.first,
                                              [&](std::size_t i) { return rest.first - 1 - i; }));
  }
  return kept;
}

}  // namespace

std::vector<signal::Rest> steady_parts(View<View<double>> axes,
                                       const std::vector<signal::Rest>& rests,
                                       double rate_hz,
                                       double shortest_s) {
  const RestMeans found = rest_means(axes, rests, rate_hz);
  std::vector<std::vector<SteadyPart>> of_rest;
  std::vector<SteadyPart> all;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    of_rest.push_back(parts_of(found, i));
    all.insert(all.end(), of_rest.back().begin(), of_rest.back().end());
  }
  constexpr std::size_t reach = 1000;  // parts before and after, so that time grows with the rests
  std::vector<signal::Rest> steady;
  std::size_t next = 0;  // of `all`, the first part of the rest
  for (std::size_t i = 0; i < rests.size(); ++i) {
    const std::size_t from = next - std::min(next, reach);
    next += of_rest[i].size();
    const std::size_t blocks = found.of_rest[i].size();
    if (blocks == 0 || (of_rest[i].size() == 1 && of_rest[i].front().size() == blocks)) {
      steady.push_back(without_onset(axes, found, rests[i]));
      continue;
    }
    keep_usual_level(std::span(all).subspan(from, std::min(next + reach, all.size()) - from),
                     found.std, of_rest[i]);
    for (const SteadyPart& part : of_rest[i]) {
      const std::size_t first = rests[i].first;
      const signal::Rest kept{
          first + part.first * found.length,
          part.end == blocks ? rests[i].last : first + part.end * found.length - 1};
      if (static_cast<double>(kept.last - kept.first + 1) >= shortest_s * rate_hz)
        steady.push_back(without_onset(axes, found, kept));
    }
  }
  // A stretch that begins and ends slowly and is hardly longer than that may be a slow motion whose
  // acceleration vanishes, or cancels gravity on a slope, for a moment.
  const double least = 0.95 * shortest_s * rate_hz - 1.0;  // find_rests() rounds its blocks down
  std::erase_if(steady, [&](const signal::Rest& rest) {
    return rest.first >= found.length && rest.last + found.length < axes[0].size() &&
           static_cast<double>(rest.last - rest.first + 1) < least;
  });
  return steady;
}

std::vector<signal::Rest> quiet_stretches(View<View<double>> axes,
                                          double rate_hz,
                                          double shortest_s) {
  const auto length =
      std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(0.25 * rate_hz)));
  const Blocks blocks = blocks_of(axes, length);
  const std::size_t n = blocks.scatter.size();
  const auto quiet = quantile(blocks.scatter, 0.1), loud = quantile(blocks.scatter, 0.9);
  std::vector<signal::Rest> rests;
  if (n < 8 || !quiet || !(*quiet * 5.0 < *loud)) return rests;
  const double limit = 4.0 * *quiet;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t end = i;
    while (end < n && blocks.scatter[end] <= limit &&
           distance(blocks.mean[end], blocks.mean[i]) <= limit)
      ++end;
    if (end == i) continue;
    // Next to motion a block may contain its beginning.
    const std::size_t first = i == 0 ? 0 : i + 1, last = end == n ? n : end - 1;
    if (last > first && static_cast<double>((last - first) * length) >= shortest_s * rate_hz)
      rests.push_back({first * length, last == n ? axes[0].size() - 1 : last * length - 1});
    i = end - 1;
  }
  return rests;
}

Stops find_stops(View<View<double>> axes,
                 View<double> time_s,
                 double rate_hz,
                 const TrackOptions& options) {
  Stops given;
  for (const TimeSpan& span : options.still) {
    const signal::Rest rest = span_to_rest(span, time_s);
    if (rest.first < rest.last && rest.last < time_s.size()) given.rests.push_back(rest);
  }
  if (!given.rests.empty()) {
    given.rests = united(std::move(given.rests));
    return given;
  }
  signal::RestSearch search =
      signal::find_rests(axes, {.rate_hz = rate_hz, .shortest_s = options.shortest_rest_s});
  const double shortest_s = options.shortest_rest_s.value_or(0.5);
  Stops stops{steady_parts(axes, search.rests, rate_hz, shortest_s), false,
              std::move(search.why_none)};
  for (const signal::Rest& rest : search.rests)
    stops.quiet_s += time_s[rest.last] - time_s[rest.first];
  if (stops.rests.empty()) {
    stops.rests = quiet_stretches(axes, rate_hz, shortest_s);
    stops.by_quietness = !stops.rests.empty();
  }
  if (options.only_end_rests && stops.rests.size() > 2)
    stops.rests = {stops.rests.front(), stops.rests.back()};
  return stops;
}

}  // namespace proofmass::estimate
