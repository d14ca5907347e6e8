#include "proofmass/report/wheel/report.hpp"

#include <algorithm>

#include "proofmass/core/units.hpp"

namespace proofmass::report {
namespace {

Channel channel(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, parse_unit(unit).value_or(Unit{Quantity::unknown, 1.0, 0.0, unit}), values};
}

}  // namespace

Recording wheel_series(const WheelReport& report) {
  const estimate::WheelSeries& series = report.solution.series;
  Recording out;
  out.source = "proofmass wheel";
  out.format = "series";
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = series.time_s;
  out.channels = {channel("angle", "rad", series.angle_rad),
                  channel("angle_std", "rad", series.angle_std_rad),
                  channel("speed", "rad/s", series.speed_radps),
                  channel("speed_std", "rad/s", series.speed_std_radps),
                  channel("accel", "rad/s^2", series.accel_radps2),
                  channel("accel_std", "rad/s^2", series.accel_std_radps2),
                  channel("filtered_angle", "rad", series.filtered_angle_rad),
                  channel("filtered_angle_std", "rad", series.filtered_angle_std_rad),
                  channel("atan2_angle", "rad", series.atan2_angle_rad),
                  channel("double_integral_angle", "rad", series.double_integral_angle_rad)};
  // A method without results has no column.
  std::erase_if(out.channels,
                [&](const Channel& c) { return c.values.size() != series.time_s.size(); });
  return out;
}

}  // namespace proofmass::report
