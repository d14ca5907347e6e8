#include "proofmass/signal/even_grid.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t nearby = 8;  // samples about a long step that may make up for it

// Samples missing before sample k, whose step is a long one.
double missing_before(View<double> stamps_s, std::size_t k, double rate_hz) {
  const double by_step = std::round((stamps_s[k] - stamps_s[k - 1]) * rate_hz) - 1.0;
  const std::size_t first = k - std::min(k, nearby);
  const std::size_t last = std::min(k + nearby, stamps_s.size() - 1);
  const double by_others =
      std::round((stamps_s[last] - stamps_s[first]) * rate_hz) - static_cast<double>(last - first);
  // Where another hole is near, the others count it too; by_step bounds what this one has of it.
  return std::max(0.0, std::min(by_step, by_others));
}

}  // namespace

Result<EvenGrid> even_grid(const TimeBase& time, std::size_t samples) {
  if (!(time.rate_hz > 0.0)) return Error{Errc::invalid_argument, "no sample rate is known"};
  EvenGrid grid{.rate_hz = time.rate_hz, .recorded = samples, .missing = 0, .holes = {}};
  const View<double> stamps_s = time.stamps_s;
  if (time.is_uniform() || samples < 2) return grid;
  PM_EXPECTS(stamps_s.size() == samples);
  const double most = 3.0 * static_cast<double>(samples);
  double squares = 0.0, total = 0.0;
  std::size_t regular = 0;
  bool ascending = true;
  for (std::size_t k = 1; k < samples; ++k) {
    const double steps = (stamps_s[k] - stamps_s[k - 1]) * time.rate_hz;
    ascending = ascending && steps > -1.0;
    if (!(steps > 1.5)) {
      squares += (steps - 1.0) * (steps - 1.0);
      ++regular;
      continue;
    }
    const double missing = missing_before(stamps_s, k, time.rate_hz);
    total += missing;
    if (!(total <= most)) {
      return Error{Errc::corrupt,
                   fmt::format("the gaps in the stamps are as long as {:.3g} samples, and there "
                               "are {}: use --from and --to, or --rate to pass over the stamps",
                               total, samples)};
    }
    if (missing > 0.0) grid.holes.push_back({k, static_cast<std::size_t>(missing)});
  }
  grid.missing = static_cast<std::size_t>(total);
  if (regular > 0) grid.relative_jitter = std::sqrt(squares / static_cast<double>(regular));
  const double duration_s = stamps_s.back() - stamps_s.front();
  const double mean_hz = static_cast<double>(samples + grid.missing - 1) / duration_s;
  if (ascending && std::abs(mean_hz / time.rate_hz - 1.0) < 0.02) grid.rate_hz = mean_hz;
  return grid;
}

std::vector<double> on_even_grid(View<double> values, const EvenGrid& grid) {
  PM_EXPECTS(values.size() == grid.recorded);
  std::vector<double> series;
  series.reserve(grid.recorded + grid.missing);
  auto hole = grid.holes.begin();
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (hole != grid.holes.end() && hole->before == k) {
      series.insert(series.end(), hole->missing, std::numeric_limits<double>::quiet_NaN());
      ++hole;
    }
    series.push_back(is_plausible(values[k]) ? values[k]
                                             : std::numeric_limits<double>::quiet_NaN());
  }
  return series;
}

}  // namespace proofmass::signal
