#include "proofmass/estimate/track_stops.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

// Means and scatter of the axes over blocks of samples.
struct Blocks {
  std::size_t length = 0;
  std::vector<double> scatter;  // root of the sum over axes; NaN without readings
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

}  // namespace

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
    // Next to motion a block may hold its beginning.
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
  Stops told;
  for (const TimeSpan& span : options.still) {
    const signal::Rest rest = span_to_rest(span, time_s);
    if (rest.first < rest.last && rest.last < time_s.size()) told.rests.push_back(rest);
  }
  if (!told.rests.empty()) {
    told.rests = united(std::move(told.rests));
    return told;
  }
  signal::RestSearch search =
      signal::find_rests(axes, {.rate_hz = rate_hz, .shortest_s = options.shortest_rest_s});
  Stops stops{std::move(search.rests), false, std::move(search.why_none)};
  if (stops.rests.empty()) {
    stops.rests = quiet_stretches(axes, rate_hz, options.shortest_rest_s.value_or(0.5));
    stops.by_quietness = !stops.rests.empty();
  }
  if (options.only_end_rests && stops.rests.size() > 2)
    stops.rests = {stops.rests.front(), stops.rests.back()};
  return stops;
}

}  // namespace proofmass::estimate
