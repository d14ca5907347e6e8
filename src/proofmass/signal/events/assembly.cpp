#include "proofmass/signal/events/assembly.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

/// The largest deviation in a segment from the median of a second on either side.
double size_of_outlier(View<double> series, const Stretch& at, double rate_hz) {
  const std::size_t side = std::max<std::size_t>(16, samples_in(1.0, rate_hz));
  std::vector<double> beside;
  const auto keep = [&](std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k)
      if (std::isfinite(series[k])) beside.push_back(series[k]);
  };
  keep(at.first - std::min(at.first, side), at.first);
  keep(at.last + 1, std::min(at.last + 1 + side, series.size()));
  const double level = beside.empty() ? 0.0 : median_of(beside);
  double size = 0.0;
  for (std::size_t k = at.first; k <= at.last; ++k)
    if (std::isfinite(series[k]) && std::abs(series[k] - level) > std::abs(size))
      size = series[k] - level;
  return size;
}

/// Two steps that cancel within seconds are an outlier.
void pair_steps(std::vector<Step>& steps, std::vector<Hit>& hits, double rate_hz) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (k + 1 < steps.size() && steps[k + 1].at - steps[k].at <= samples_in(5.0, rate_hz) &&
        std::abs(steps[k].size + steps[k + 1].size) <
            0.3 * std::max(std::abs(steps[k].size), std::abs(steps[k + 1].size))) {
      hits.push_back({{steps[k].at, steps[k + 1].at - 1}, steps[k].sigmas});
      ++k;
    } else {
      steps[kept++] = steps[k];
    }
  }
  steps.resize(kept);
}

/// The change of the mean over up to two seconds on either side, limited by adjacent steps.
double size_of_step(const Source& source, View<Step> steps, std::size_t k, double rate_hz) {
  const Step& step = steps[k];
  const std::size_t before = step.at - (k > 0 ? steps[k - 1].at : 0);
  const std::size_t after =
      (k + 1 < steps.size() ? steps[k + 1].at : source.series.size()) - step.at;
  const std::size_t side =
      std::min({std::max(step.window, samples_in(2.0, rate_hz)), before, after});
  const double size = mean_of(source, step.at, side) - mean_of(source, step.at - side, side);
  return std::isnan(size) ? step.size : size;
}

/// A burst that coincides with a step hides the level next to the step. Measured beyond the burst,
/// the level may be unchanged: then the tail of the burst only resembled a step.
void settle_burst(const Source& source, Event& event, double rate_hz) {
  const std::size_t side = samples_in(2.0, rate_hz), margin = samples_in(0.5, rate_hz);
  const std::size_t behind = event.last + 1 + margin;
  if (event.first < side || behind + side > source.series.size()) return;
  const double change = mean_of(source, behind, side) - mean_of(source, event.first - side, side);
  if (std::isnan(change)) return;
  constexpr double least_sigmas = 4.0;
  const double sigma = std::abs(event.size) / event.significance;
  if (std::abs(change) > std::max(least_sigmas * sigma, 0.5 * std::abs(event.size))) {
    event.size = change;
    return;
  }
  event.kind = EventKind::outlier;
  event.size = size_of_outlier(source.series, {event.first, event.last}, rate_hz);
}

/// An outlier decays below its detection threshold. Extends its end in tenths of a second while
/// these means differ from the level seconds later by more than four times the scatter of the means
/// before it.
void follow_to_its_end(const Source& source, Event& event, double rate_hz) {
  const std::size_t w = std::max<std::size_t>(4, samples_in(0.1, rate_hz));
  constexpr std::size_t windows = 20, farthest = 50;
  constexpr double least_sigmas = 4.0;
  const std::size_t size = source.series.size();
  if (event.first < (windows + 1) * w || event.last + (farthest + windows) * w >= size) return;
  Moments before;
  for (std::size_t k = 2; k <= windows + 1; ++k)
    before.add(mean_of(source, event.first - k * w, w));
  const double level = mean_of(source, event.last + farthest * w, windows * w);
  if (before.count < windows / 2 || std::isnan(level)) return;
  for (std::size_t k = 0; k < farthest; ++k) {
    const double mean = mean_of(source, event.last + 1, w);
    if (!(std::abs(mean - level) > least_sigmas * before.std())) return;
    event.last += w;
  }
}

/// Measures the size of each step from the surrounding series.
void measure_steps(const Source& source, std::vector<Step>& steps, double rate_hz) {
  std::vector<double> sizes(steps.size());
  for (std::size_t k = 0; k < steps.size(); ++k) sizes[k] = size_of_step(source, steps, k, rate_hz);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].size = sizes[k];
}

/// True if a hit is caused by the step itself: a step triggers the outlier filter next to it, in a
/// window as long as that of its detection.
bool lies_beside(const Stretch& at, const Step& step, double rate_hz) {
  const std::size_t reach =
      std::max<std::size_t>(32, 2 * std::min(step.window, samples_in(0.5, rate_hz)));
  return at.first <= step.at + reach && step.at <= at.last + reach;
}

/// One event for each step, extended by adjacent hits, then one for each remaining hit.
std::vector<Event> events_from(View<double> series,
                               const std::vector<Hit>& hits,
                               const std::vector<Step>& steps,
                               double rate_hz) {
  std::vector<Event> events;
  events.reserve(steps.size() + hits.size());
  for (const Step& step : steps)
    events.push_back({EventKind::step, step.at, step.at, step.size, step.sigmas});
  for (const Hit& hit : hits) {
    const Stretch at{hit.at.first, std::min(hit.at.last, series.size() - 1)};
    const auto owner = std::ranges::find_if(
        steps, [&](const Step& step) { return lies_beside(at, step, rate_hz); });
    if (owner == steps.end()) {
      events.push_back({EventKind::outlier, at.first, at.last, size_of_outlier(series, at, rate_hz),
                        hit.sigmas});
    } else {
      Event& event = events[static_cast<std::size_t>(owner - steps.begin())];
      event.first = std::min(event.first, at.first);
      event.last = std::max(event.last, at.last);
    }
  }
  return events;
}

/// Truncates an outlier that overlaps a step.
void part_overlapping(std::vector<Event>& events) {
  for (std::size_t k = 1; k < events.size(); ++k) {
    if (events[k].first > events[k - 1].last) continue;
    events[k].first = events[k - 1].last + 1;
    events[k].last = std::max(events[k].last, events[k].first);
  }
}

}  // namespace

std::vector<Event> assemble(const Source& source,
                            std::vector<Hit> hits,
                            std::vector<Step> steps,
                            double rate_hz) {
  std::ranges::sort(steps, {}, &Step::at);
  measure_steps(source, steps, rate_hz);
  pair_steps(steps, hits, rate_hz);
  merge_hits(hits, std::max<std::size_t>(4, samples_in(0.2, rate_hz)));
  std::vector<Event> events = events_from(source.series, hits, steps, rate_hz);
  for (Event& event : events) {
    if (event.kind == EventKind::step && event.last > event.first)
      settle_burst(source, event, rate_hz);
    if (event.kind == EventKind::outlier) follow_to_its_end(source, event, rate_hz);
  }
  std::ranges::sort(events, {}, &Event::first);
  part_overlapping(events);
  std::erase_if(events, [&](const Event& event) { return event.last >= source.series.size(); });
  return events;
}

}  // namespace proofmass::signal
