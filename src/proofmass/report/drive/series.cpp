#include <cmath>
#include <cstddef>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/drive/report.hpp"
#include "proofmass/report/json.hpp"

namespace proofmass::report {
namespace {

Channel column(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, parse_unit(unit).value_or(Unit{Quantity::unknown, 1.0, 0.0, unit}), values};
}

// Metres for a radian of latitude and of longitude, on the ellipsoid of WGS 84.
struct PerRadian {
  double north_m, east_m;
  explicit PerRadian(double latitude_rad) {
    constexpr double a_m = 6378137.0, e2 = 6.69437999014e-3;
    const double w2 = 1.0 - e2 * square(std::sin(latitude_rad));
    north_m = a_m * (1.0 - e2) / (w2 * std::sqrt(w2));
    east_m = a_m / std::sqrt(w2) * std::cos(latitude_rad);
  }
};

}  // namespace

Recording drive_series(const DriveReport& report) {
  const estimate::DriveSeries& series = report.solution.series;
  Recording out;
  out.source = "proofmass drive";
  out.format = "series";
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = series.time_s;
  out.channels = {column("x", "m", series.x_m),
                  column("x_std", "m", series.x_std_m),
                  column("y", "m", series.y_m),
                  column("y_std", "m", series.y_std_m),
                  column("xy_cov", "m^2", series.xy_cov_m2),
                  column("heading", "rad", series.heading_rad),
                  column("heading_std", "rad", series.heading_std_rad),
                  column("speed", "m/s", series.speed_mps),
                  column("speed_std", "m/s", series.speed_std_mps),
                  column("heading_rate", "rad/s", series.rate_radps),
                  column("distance", "m", series.distance_m)};
  return out;
}

std::string drive_geojson(const DriveReport& report) {
  const estimate::DriveSolution& solution = report.solution;
  const estimate::DriveSeries& series = solution.series;
  Array features;
  if (solution.has_fixes && series.x_m.size() > 1) {
    const PerRadian per(solution.origin_deg[0] * rad_per_deg);
    Array line;
    for (std::size_t k = 0; k < series.x_m.size(); ++k)
      line.emplace_back(
          Array{Value(solution.origin_deg[1] + series.x_m[k] / per.east_m * deg_per_rad),
                Value(solution.origin_deg[0] + series.y_m[k] / per.north_m * deg_per_rad)});
    Object properties{{"reference_point", solution.reference_point},
                      {"distance_m", quantity(solution.distance_m, "m")},
                      {"heading_change_rad", quantity(solution.heading_change_rad, "rad")}};
    features.emplace_back(
        Object{{"type", "Feature"},
               {"geometry", Object{{"type", "LineString"}, {"coordinates", std::move(line)}}},
               {"properties", std::move(properties)}});
  }
  return json_text(Object{{"type", "FeatureCollection"}, {"features", std::move(features)}}) + "\n";
}

}  // namespace proofmass::report
