#include "proofmass/signal/even_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/chunk_statistics.hpp"
#include "proofmass/signal/resample/hole_finder.hpp"

namespace proofmass::signal {

Result<EvenGrid> even_grid(const TimeBase& time, std::size_t samples) {
  if (!(time.rate_hz > 0.0)) return Error{Errc::invalid_argument, "no sample rate is known"};
  if (time.is_uniform() || samples < 2)
    return EvenGrid{.rate_hz = time.rate_hz, .recorded = samples, .missing = 0, .holes = {}};
  const View<double> stamps_s = time.stamps_s;
  PM_EXPECTS(stamps_s.size() == samples);
  HoleFinder finder(time.rate_hz, time.band_s);
  std::vector<Hole> holes;
  constexpr std::size_t piece = 4096;
  for (std::size_t from = 0; from < samples; from += piece)
    finder.add(stamps_s.subspan(from, std::min(piece, samples - from)), holes);
  finder.finish(holes);
  if (Status possible = finder.check(samples, 0.0); !possible) return possible.error();
  EvenGrid grid = finder.grid();
  grid.holes = std::move(holes);
  return grid;
}

Samples on_even_grid(Samples values, const EvenGrid& grid) {
  PM_EXPECTS(values.size() == grid.recorded);
  bool any = false;
  for_each_implausible(values, [&](std::size_t k) { any = any || !std::isnan(values[k]); });
  if (any)
    for (double& value : values.edit()) value = plausible_or_nan(value);
  if (grid.holes.empty()) return values;
  std::vector<double> series;
  series.reserve(grid.recorded + grid.missing);
  const double* from = values.begin();
  const auto append = [&](std::size_t end) {
    const double* last = values.begin() + end;
    series.insert(series.end(), from, last);
    from = last;
  };
  for (const Hole& hole : grid.holes) {
    append(hole.before);
    series.insert(series.end(), hole.missing, std::numeric_limits<double>::quiet_NaN());
  }
  append(values.size());
  return series;
}

Recording with_even_stamps(Recording recording) {
  TimeBase& time = recording.time;
  if (!(time.band_s > 0.0) || time.is_uniform()) return recording;
  const Result<EvenGrid> grid = even_grid(time, recording.samples());
  if (!grid) return recording;
  std::vector<double> late_s;
  std::size_t missing = 0;
  auto hole = grid->holes.begin();
  for (std::size_t k = 0; k < time.stamps_s.size(); ++k) {
    for (; hole != grid->holes.end() && hole->before == k; ++hole) missing += hole->missing;
    const double even_s = static_cast<double>(k + missing) / time.rate_hz;
    late_s.push_back(time.stamps_s[k] - even_s);
    time.stamps_s[k] = even_s;
  }
  constexpr double ns_per_s = 1e9;
  if (time.start_ns) *time.start_ns += std::llround(*median(std::move(late_s)) * ns_per_s);
  time.band_s = 0.0;
  recording.notes.push_back(
      {Severity::info, time.channel + ": the stamps do not show single intervals: the samples are "
                                      "taken to be evenly spaced"});
  return recording;
}

}  // namespace proofmass::signal
