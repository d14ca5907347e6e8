#include "proofmass/estimate/track/aided.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "proofmass/estimate/attitude.hpp"
#include "proofmass/estimate/track/findings.hpp"
#include "proofmass/estimate/track/motion.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::estimate {
namespace {

using Direction = std::array<double, 3>;

double along(const Direction& axis, const Mat<3>& v) {
  return axis[0] * v(0) + axis[1] * v(1) + axis[2] * v(2);
}

double variance_along(const Direction& d, const Symmetric3& cov) {
  return d[0] * d[0] * cov[0] + d[1] * d[1] * cov[3] + d[2] * d[2] * cov[5] +
         2.0 * (d[0] * d[1] * cov[1] + d[0] * d[2] * cov[2] + d[1] * d[2] * cov[4]);
}

Direction unit(const Direction& d) {
  const double length = std::hypot(d[0], d[1], d[2]);
  return {d[0] / length, d[1] / length, d[2] / length};
}

FoundAxis axis_of(const Attitude& attitude, View<double> time_s, const TrackOptions& options) {
  if (options.axis) return {unit(*options.axis), 1.0};
  std::vector<std::vector<double>> velocity(3);
  for (const Mat<3>& v : attitude.velocity_mps)
    for (int i = 0; i < 3; ++i) velocity[static_cast<std::size_t>(i)].push_back(v(i));
  return farthest_axis(velocity, time_s, {0, 1, 2});
}

std::vector<PositionReading> readings_along(const Direction& axis, const TrackReadings& readings) {
  std::vector<PositionReading> out;
  for (const auto& fix : readings.fixes)
    out.push_back({fix.sample, Mat<3>(axis[0], axis[1], axis[2]), fix.position_m, fix.variance_m2,
                   fix.after_s});
  return out;
}

void fill(const Attitude& attitude,
          const std::array<std::vector<double>, 3>& accel,
          TrackSolution& solution) {
  TrackSeries& series = solution.series;
  const Direction& axis = solution.axis;
  const auto std_of = [&](const Symmetric3& cov, double value) {
    return std::hypot(std::sqrt(std::max(0.0, variance_along(axis, cov))),
                      solution.scale_std * value);
  };
  for (std::size_t k = 0; k < attitude.position_m.size(); ++k) {
    const double p = along(axis, attitude.position_m[k]);
    const double v = along(axis, attitude.velocity_mps[k]);
    const double f = along(axis, attitude.filtered_position_m[k]);
    series.position_m.push_back(p);
    series.position_std_m.push_back(std_of(attitude.position_cov_m2[k], p));
    series.velocity_mps.push_back(v);
    series.velocity_std_mps.push_back(std_of(attitude.velocity_cov_m2ps2[k], v));
    series.filtered_position_m.push_back(f);
    series.filtered_velocity_mps.push_back(along(axis, attitude.filtered_velocity_mps[k]));
    series.filtered_position_std_m.push_back(std_of(attitude.filtered_position_cov_m2[k], f));
    series.accel_mps2.push_back(along(axis, {accel[0][k], accel[1][k], accel[2][k]}));
  }
}

// Measurements that no sensor gives, such as 3e34, are missing.
InertialSeries usable_series(const TrackSensor& sensor) {
  InertialSeries series{sensor.time_s, sensor.rate_radps, sensor.accel_mps2};
  for (auto* sensors : {&series.rate_radps, &series.accel_mps2})
    for (auto& axis : *sensors)
      for (double& value : axis) value = signal::plausible_or_nan(value);
  return series;
}

// Outside of a stretch the attitude is NaN.
Result<Attitude> undivided_attitude(const InertialSeries& usable,
                                    const std::vector<signal::Rest>& rests,
                                    const AttitudeOptions& how) {
  auto found = estimate_attitude(usable, rests, how);
  if (!found) return found.error();
  const auto& stretches = found->stretches;
  if (stretches.size() != 1 || stretches.front().first != 0 ||
      stretches.front().last + 1 != usable.time_s.size())
    return Error{Errc::not_observable,
                 "a gap, or a rotation beyond the gyroscope's range, of more than a second parts "
                 "the recording, and with it the attitude: analyse one part, or omit the gyroscope",
                 {Advice{"from"}, Advice{"to"}, Advice{"no-gyro"}}};
  return found;
}

}  // namespace

Result<TrackSignal> world_signal(const TrackSensor& sensor,
                                 const TrackSignal& signal,
                                 const TrackOptions& options) {
  const InertialSeries usable = usable_series(sensor);
  AttitudeOptions how;
  how.gravity_mps2 = options.gravity_mps2;
  how.progress = options.progress;
  const auto found =
      undivided_attitude(usable, {signal.stops.rests.front(), signal.stops.rests.back()}, how);
  if (!found) return found.error();
  TrackSignal world = signal;
  const auto accel = gravity_free_acceleration(usable, *found);
  world.accel_mps2.assign(accel.begin(), accel.end());
  world.axes = {0, 1, 2};
  world.reference_mps2.assign(3, 0.0);
  world.gravity = GravityContent::removed;
  world.resting_norm_mps2.reset();
  return world;
}

Result<bool> track_aided(const TrackSensor& sensor,
                         const TrackSignal& signal,
                         const TrackReadings& readings,
                         const TrackOptions& options,
                         TrackSolution& solution) {
  const InertialSeries usable = usable_series(sensor);
  AttitudeOptions how;
  how.gravity_mps2 = options.gravity_mps2;
  how.progress = options.progress;
  auto found = undivided_attitude(usable, signal.stops.rests, how);
  if (!found) return found.error();
  const FoundAxis axis = axis_of(*found, sensor.time_s, options);
  if (!readings.fixes.empty()) {
    how.positions = readings_along(axis.direction, readings);
    found = estimate_attitude(usable, signal.stops.rests, how);
    if (!found) return found.error();
  }
  const Attitude& attitude = *found;
  solution.axis = axis.direction;
  solution.axis_in_world = true;
  solution.travel_share = axis.share;
  solution.scale_std = scale_std(signal, options, solution);
  fill(attitude, gravity_free_acceleration(usable, attitude), solution);
  solution.notes.insert(solution.notes.end(), attitude.notes.begin(), attitude.notes.end());
  std::size_t unused = 0;
  std::erase_if(solution.rests, [&](const signal::Rest& rest) {
    const bool drop =
        std::any_of(attitude.rests.begin(), attitude.rests.end(),
                    [&](const RestUse& use) { return !use.used && use.rest.first == rest.first; });
    unused += drop ? 1U : 0U;
    return drop;
  });
  if (unused > 0)
    solution.notes.push_back({Severity::info, std::to_string(unused) +
                                                  " quiet intervals are not rests: the gyroscope "
                                                  "measures rotation"});
  ConsistencyCheck check({.channels = {"gyroscope and accelerometer at rest"}});
  for (std::size_t k = 0; k < attitude.nis.size(); ++k)
    if (attitude.readings[k] > 0)
      check.add_nis(static_cast<double>(attitude.nis[k]), attitude.readings[k]);
  solution.consistency = check.judge();
  return true;
}

}  // namespace proofmass::estimate
