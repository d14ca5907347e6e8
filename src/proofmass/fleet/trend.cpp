#include "proofmass/fleet/trend.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "proofmass/core/statistics.hpp"

namespace proofmass::fleet {
namespace {

constexpr double least_dof = 3.0;

struct Level {
  double x = 0.0, y = 0.0, count = 0.0;
};

// The slope about the levels of groups: every sensor by itself, or all as one.
std::optional<Trend> slope_about(const std::vector<TrendPoint>& points, bool within_sensors) {
  std::map<std::size_t, Level> levels;
  const auto group = [&](const TrendPoint& point) { return within_sensors ? point.sensor : 0; };
  for (const TrendPoint& point : points) {
    Level& level = levels[group(point)];
    level.x += point.x;
    level.y += point.y;
    level.count += 1.0;
  }
  double xx = 0.0, xy = 0.0, yy = 0.0, all_x = 0.0;
  for (const TrendPoint& point : points) {
    const Level& level = levels[group(point)];
    const double x = point.x - level.x / level.count, y = point.y - level.y / level.count;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    all_x = std::max(all_x, std::abs(point.x));
  }
  const double dof = static_cast<double>(points.size()) - static_cast<double>(levels.size()) - 1.0;
  const double rounding = 1e-12 * all_x;
  if (dof < least_dof || !(xx > square(rounding) * static_cast<double>(points.size())))
    return std::nullopt;
  const double slope = xy / xx;
  const double std = std::sqrt(std::max(0.0, yy - slope * xy) / dof / xx);
  if (!(std > 0.0)) return std::nullopt;
  const double reach = student_t_quantile(0.975, dof) * std;
  return Trend{
      {slope, std}, {slope - reach, slope + reach}, student_t_p(slope / std, dof), within_sensors};
}

}  // namespace

std::optional<Trend> fit_trend(const std::vector<TrendPoint>& points) {
  auto trend = slope_about(points, true);
  return trend ? trend : slope_about(points, false);
}

}  // namespace proofmass::fleet
