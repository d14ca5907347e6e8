#include "proofmass/signal/audit/range_limit.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/audit/range_limit_crests.hpp"

namespace proofmass::signal {

std::optional<RangeLimit> find_upper_limit(View<double> series) {
  Extent extent{.median = median_or_zero(series)};
  bool any = false;
  for (const double x : series) {
    if (!std::isfinite(x)) continue;
    extent.low = any ? std::min(extent.low, x) : x;
    extent.high = any ? std::max(extent.high, x) : x;
    any = true;
  }
  if (const auto hard = find_hard_limit(series, extent)) return hard;
  if (const auto crowded = find_crowded_limit(series, extent)) return crowded;
  return find_soft_limit(series, extent);
}

std::vector<double> slopes_at(View<double> series, double level) {
  std::vector<double> out;
  for (std::size_t k = 2; k + 2 < series.size(); ++k) {
    if ((series[k] >= level) == (series[k - 1] >= level)) continue;
    const double slope = (series[k + 1] - series[k - 2]) / 3.0;
    if (std::isfinite(slope + series[k] + series[k - 1])) out.push_back(slope);
  }
  return out;
}

std::vector<Excursion> excursions_above(View<double> series, double level) {
  std::vector<Excursion> out;
  std::optional<double> from;
  for (std::size_t k = 1; k < series.size(); ++k) {
    const double before = series[k - 1], here = series[k];
    if (std::isnan(before) || std::isnan(here)) {
      from.reset();
      continue;
    }
    if ((before >= level) == (here >= level)) continue;
    const double at = static_cast<double>(k - 1) + (level - before) / (here - before);
    if (here >= level) {
      from = at;
    } else if (from) {
      out.push_back({*from, at});
      from.reset();
    }
  }
  return out;
}

double spread_of_durations(const std::vector<Excursion>& excursions) {
  std::vector<double> durations;
  for (const Excursion& one : excursions) durations.push_back(one.duration());
  const double middle = median_or_zero(durations);
  if (!(middle > 0.0)) return 0.0;
  for (double& duration : durations) duration = std::abs(duration - middle);
  return median_or_zero(durations) / middle;
}

double period_of(const std::vector<Excursion>& excursions) {
  std::vector<double> periods;
  for (std::size_t k = 1; k < excursions.size(); ++k)
    periods.push_back(excursions[k].middle() - excursions[k - 1].middle());
  return median_or_zero(periods);
}

double rms_about_line(View<double> x, View<double> y) {
  const Moments of_x = moments(x), of_y = moments(y);
  double products = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) products += (x[k] - of_x.mean) * (y[k] - of_y.mean);
  const double explained = of_x.squares > 0.0 ? products * products / of_x.squares : 0.0;
  return std::sqrt(std::max(0.0, of_y.squares - explained) / static_cast<double>(x.size()));
}

double median_or_zero(View<double> values) {
  return median(values).value_or(0.0);
}

}  // namespace proofmass::signal
