#include "proofmass/report/track/report.hpp"

#include "proofmass/core/units.hpp"

namespace proofmass::report {
namespace {

Channel channel(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, *parse_unit(unit), values};
}

}  // namespace

Recording track_series(const TrackReport& report) {
  const estimate::TrackSeries& series = report.solution.series;
  Recording out;
  out.source = "proofmass track";
  out.format = "series";
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = series.time_s;
  if (report.solution.smoother) {
    out.channels = {channel("position", "m", series.position_m),
                    channel("position_std", "m", series.position_std_m),
                    channel("velocity", "m/s", series.velocity_mps),
                    channel("velocity_std", "m/s", series.velocity_std_mps),
                    channel("filtered_position", "m", series.filtered_position_m),
                    channel("filtered_position_std", "m", series.filtered_position_std_m),
                    channel("filtered_velocity", "m/s", series.filtered_velocity_mps),
                    channel("double_integral_position", "m", series.double_integral_m)};
  }
  out.channels.push_back(channel("accel", "m/s^2", series.accel_mps2));
  out.channels.push_back(
      {"resting", {}, std::vector<double>(series.resting.begin(), series.resting.end())});
  // A method without results has no column.
  std::erase_if(out.channels,
                [&](const Channel& c) { return c.values.size() != series.time_s.size(); });
  return out;
}

}  // namespace proofmass::report
