#include "proofmass/report/tilt/report.hpp"

#include <array>

#include "proofmass/core/units.hpp"

namespace proofmass::report {
namespace {

Channel channel(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, *parse_unit(unit), values};
}

}  // namespace

Recording tilt_series(const TiltReport& report) {
  Recording out;
  out.source = "proofmass tilt";
  out.format = "series";
  if (report.axis) {
    const estimate::AxisTiltSeries& s = report.axis->series;
    out.time.source = TimeSource::stamps;
    out.time.stamps_s = s.time_s;
    out.channels = {channel("angle", "rad", s.angle_rad),
                    channel("angle_std", "rad", s.angle_std_rad),
                    channel("filtered_angle", "rad", s.filtered_angle_rad),
                    channel("filtered_angle_std", "rad", s.filtered_angle_std_rad),
                    channel("rate_bias", "rad/s", s.rate_bias_radps),
                    channel("rate_bias_std", "rad/s", s.rate_bias_std_radps)};
    out.channels.push_back({"weight", {}, std::vector<double>(s.weight.begin(), s.weight.end())});
    return out;
  }
  const estimate::TiltSeries& s = report.solution->series;
  out.time.source = s.time_s.empty() ? TimeSource::none : TimeSource::stamps;
  out.time.stamps_s = s.time_s;
  out.channels = {channel("roll", "rad", s.roll_rad),
                  channel("roll_std", "rad", s.roll_std_rad),
                  channel("pitch", "rad", s.pitch_rad),
                  channel("pitch_std", "rad", s.pitch_std_rad),
                  channel("filtered_roll", "rad", s.filtered_roll_rad),
                  channel("filtered_roll_std", "rad", s.filtered_roll_std_rad),
                  channel("filtered_pitch", "rad", s.filtered_pitch_rad),
                  channel("filtered_pitch_std", "rad", s.filtered_pitch_std_rad)};
  constexpr std::array up{"up_x", "up_y", "up_z"};
  for (std::size_t i = 0; i < 3; ++i) out.channels.push_back({up[i], {}, s.up[i]});
  out.channels.push_back({"weight", {}, std::vector<double>(s.weight.begin(), s.weight.end())});
  out.channels.push_back({"at_rest", {}, std::vector<double>(s.resting.begin(), s.resting.end())});
  return out;
}

}  // namespace proofmass::report
