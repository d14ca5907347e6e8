#include "proofmass/report/noise/report.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "proofmass/report/noise/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DeviationCurve;
using characterise::DeviationPoint;
const DeviationPoint* point_at(const DeviationCurve& curve, double tau_s) {
  const auto at = std::ranges::lower_bound(curve.points, tau_s, {}, &DeviationPoint::tau_s);
  return at != curve.points.end() && at->tau_s == tau_s ? &*at : nullptr;
}

void add_columns(const ChannelNoise& channel, const std::vector<double>& taus, Recording& table) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values, lower, upper;
  for (const double tau_s : taus) {
    const DeviationPoint* point = point_at(channel.analysis->deviation, tau_s);
    values.push_back(point != nullptr ? point->value : none);
    lower.push_back(point != nullptr ? point->lower : none);
    upper.push_back(point != nullptr ? point->upper : none);
  }
  Unit unit = channel.unit;
  unit.symbol = noise_unit(unit, curve_scale(channel.analysis->deviation.statistic));
  table.channels.push_back({channel.name, unit, std::move(values)});
  table.channels.push_back({channel.name + "_lower", unit, std::move(lower)});
  table.channels.push_back({channel.name + "_upper", unit, std::move(upper)});
}

}  // namespace

Recording noise_series(const NoiseReport& report) {
  std::set<double> all;
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis) continue;
    for (const DeviationPoint& point : channel.analysis->deviation.points) all.insert(point.tau_s);
  }
  const std::vector<double> taus(all.begin(), all.end());
  Recording table;
  table.source = "proofmass noise";
  table.format = "series";
  table.channels.push_back({"tau_s", {}, taus});
  for (const ChannelNoise& channel : report.channels) {
    if (channel.analysis) add_columns(channel, taus, table);
  }
  return table;
}

}  // namespace proofmass::report
