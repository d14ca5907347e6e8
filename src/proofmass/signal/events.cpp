#include "proofmass/signal/events.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/events/assembly.hpp"
#include "proofmass/signal/events/coarse_scales.hpp"
#include "proofmass/signal/events/fine_scales.hpp"

namespace proofmass::signal {
namespace {

void add_missing(Source& source, const std::vector<Hit>& hits) {
  std::vector<Hit> all;
  all.reserve(source.missing.size() + hits.size());
  for (const Stretch& gap : source.missing) all.push_back({gap, 0.0});
  for (const Hit& hit : hits)
    all.push_back({{hit.at.first - std::min<std::size_t>(hit.at.first, 2), hit.at.last + 2}, 0.0});
  merge_hits(all, 1);
  source.missing.clear();
  source.missing.reserve(all.size());
  for (const Hit& hit : all) source.missing.push_back(hit.at);
}

}  // namespace

std::vector<Event> find_events(View<double> series, const EventOptions& options) {
  PM_EXPECTS(std::isfinite(options.rate_hz) && options.rate_hz > 0.0);
  if (series.size() < 16) return {};
  Grain grain = grain_of(series);
  Source source{series, std::move(grain.stuck)};
  const FineTallies blocks = tally_fine_scales(source);

  // √1.25 is the filter's gain for white noise.
  const double fine_sigma = group_scales(blocks[0], blocks[0].size(), 0.0)[0] / std::sqrt(1.25);
  const bool dithered = fine_sigma >= 0.5 * grain.quantum;
  const double outlier_floor = dithered ? 0.0 : 0.5 * grain.quantum;
  const double step_floor = dithered ? 0.0 : 0.3 * grain.quantum;
  std::array<Bar, fine_scales> bars;
  for (std::size_t scale = 0; scale < bars.size(); ++scale)
    bars[scale] =
        bar_of(blocks[scale], group_of(options.rate_hz, fine_block), outlier_floor, series.size());

  std::vector<Hit> hits = hits_on_fine_scales(source, blocks, bars);
  add_missing(source, hits);
  std::vector<Step> steps;
  search_coarse_scales({source, options.rate_hz, step_floor, outlier_floor}, hits, steps);
  return assemble(source, std::move(hits), std::move(steps), options.rate_hz);
}

void drop_events(std::span<double> series, const std::vector<Event>& events, double rate_hz) {
  PM_EXPECTS(std::isfinite(rate_hz) && rate_hz > 0.0);
  const std::size_t margin = std::max<std::size_t>(2, samples_in(0.1, rate_hz));
  for (const Event& event : events) {
    const std::size_t end = std::min(event.last + margin + 1, series.size());
    for (std::size_t k = event.first - std::min(event.first, margin); k < end; ++k) series[k] = nan;
  }
}

}  // namespace proofmass::signal
