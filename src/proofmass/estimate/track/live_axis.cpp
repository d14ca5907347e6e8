#include "proofmass/estimate/track/live_axis.hpp"

#include <cmath>
#include <utility>

namespace proofmass::estimate {
namespace {

std::array<bool, 3> axes_there(const Triad& sensor) {
  return {sensor.x.has_value(), sensor.y.has_value(), sensor.z.has_value()};
}

}  // namespace

Status check_live_axis(const Triad& sensor, const std::array<double, 3>& axis) {
  double length = 0.0;
  const std::array there = axes_there(sensor);
  for (std::size_t i = 0; i < there.size(); ++i) {
    const double part = axis[i];
    if (!there[i] && part != 0.0)
      return Error{Errc::invalid_argument, sensor.name +
                                               ": the given axis has a part along an axis that the "
                                               "sensor lacks; give 0 there"};
    length = std::hypot(length, part);
  }
  if (length > 0.0 && std::isfinite(length)) return Done{};
  return Error{Errc::invalid_argument, "live track: the axis must have a direction, such as 1,0,0"};
}

Mat<3> unit_vector(const std::array<double, 3>& axis) {
  return Mat<3>(axis[0], axis[1], axis[2]).normalized();
}

FoundAxis axis_of_motion(const std::vector<LiveReading>& motion,
                         const LiveReading& level,
                         const Triad& sensor,
                         bool stopped) {
  const std::array there = axes_there(sensor);
  std::vector<std::size_t> axes;
  std::vector<std::vector<double>> velocity;
  std::vector<double> time_s;
  for (const LiveReading& reading : motion) time_s.push_back(reading.time_s);
  for (std::size_t axis = 0; axis < there.size(); ++axis) {
    if (!there[axis]) continue;
    const auto i = static_cast<Eigen::Index>(axis);
    axes.push_back(axis);
    std::vector<double>& v = velocity.emplace_back();
    double sum = 0.0, last_s = level.time_s;
    for (const LiveReading& reading : motion) {
      sum += (reading.accel_mps2(i) - level.accel_mps2(i)) *
             (reading.time_s - std::exchange(last_s, reading.time_s));
      v.push_back(sum);
    }
    if (!stopped) continue;
    const double slope = sum / (last_s - level.time_s);
    for (std::size_t k = 0; k < v.size(); ++k) v[k] -= slope * (time_s[k] - level.time_s);
  }
  return farthest_axis(velocity, time_s, axes);
}

}  // namespace proofmass::estimate
