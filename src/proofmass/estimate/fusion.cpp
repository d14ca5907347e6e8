#include "proofmass/estimate/fusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proofmass/estimate/common_axis.hpp"

namespace proofmass::estimate {
namespace {

Status check_sensor(const AxisSensor& sensor, std::size_t size) {
  if (sensor.accel_mps2.size() != size)
    return Error{Errc::invalid_argument, std::to_string(sensor.accel_mps2.size()) +
                                             " readings for " + std::to_string(size) + " times"};
  if (!(sensor.accel_variance_m2ps4 > 0.0) || !std::isfinite(sensor.accel_variance_m2ps4))
    return Error{Errc::invalid_argument, "the variance of a reading must be positive"};
  if (std::any_of(sensor.accel_mps2.begin(), sensor.accel_mps2.end(),
                  [](double x) { return std::isinf(x); }))
    return Error{Errc::not_finite, "a reading is infinite; NaN says there is none"};
  const bool bias_known = sensor.bias_std_mps2 >= 0.0 && sensor.bias_psd_m2ps5 >= 0.0 &&
                          std::isfinite(sensor.bias_mps2);
  if (!bias_known)
    return Error{Errc::invalid_argument, "a bias needs a value, a std and a density, not negative"};
  if (sensor.bias_time_constant_s && !(*sensor.bias_time_constant_s > 0.0))
    return Error{Errc::invalid_argument, "the time constant of a bias must be positive"};
  return Done{};
}

Status check_readings(const std::vector<AxisReading>& readings, std::size_t size) {
  for (const AxisReading& reading : readings)
    if (reading.sample >= size || !(reading.std > 0.0) || !std::isfinite(reading.value))
      return Error{Errc::invalid_argument,
                   "a velocity or position needs a sample inside, a value and a positive std"};
  return Done{};
}

Status check(const std::vector<double>& time_s,
             const std::vector<AxisSensor>& sensors,
             const FusionOptions& options) {
  if (sensors.empty() || sensors.size() > most_fused_sensors)
    return Error{Errc::invalid_argument, std::to_string(sensors.size()) + " sensors; 1 to " +
                                             std::to_string(most_fused_sensors) + " are fused"};
  if (time_s.size() < 2)
    return Error{Errc::too_few_samples, std::to_string(time_s.size()) + " samples; 2 are needed"};
  for (std::size_t k = 0; k < time_s.size(); ++k)
    if (!std::isfinite(time_s[k]) || (k > 0 && time_s[k] <= time_s[k - 1]))
      return Error{Errc::invalid_argument, "time must be finite and ascend"}.at("sample " +
                                                                                std::to_string(k));
  if (!(options.jerk_psd_m2ps5 > 0.0))
    return Error{Errc::invalid_argument, "the density of the jerk must be positive"};
  for (const AxisSensor& sensor : sensors)
    if (const Status status = check_sensor(sensor, time_s.size()); !status)
      return status.error().at(sensor.name);
  if (const Status status = check_readings(options.velocities_mps, time_s.size()); !status)
    return status;
  return check_readings(options.positions_m, time_s.size());
}

AxisEstimate estimate_any(const std::vector<double>& time_s,
                          const Chosen& sensors,
                          const FusionOptions& options) {
  switch (sensors.size()) {
    case 1:
      return estimate_axis<1>(time_s, sensors, options);
    case 2:
      return estimate_axis<2>(time_s, sensors, options);
    case 3:
      return estimate_axis<3>(time_s, sensors, options);
    default:
      return estimate_axis<4>(time_s, sensors, options);
  }
}

double mean_square(const std::vector<double>& std) {
  double sum = 0.0;
  for (const double x : std) sum += x * x;
  return sum / static_cast<double>(std.size());
}

/// Of the best single sensor over the fused one.
double gain(const FusedMotion& motion, std::vector<double> AxisMotion::* std) {
  double best = std::numeric_limits<double>::infinity();
  for (const AxisEstimate& single : motion.single)
    best = std::min(best, mean_square(single.smoothed.*std));
  const double fused = mean_square(motion.fused.smoothed.*std);
  return fused > 0.0 ? best / fused : 1.0;
}

}  // namespace

Result<FusedMotion> fuse_axis(const std::vector<double>& time_s,
                              const std::vector<AxisSensor>& sensors,
                              const FusionOptions& options) {
  if (const Status status = check(time_s, sensors, options); !status) return status.error();
  Chosen all;
  for (const AxisSensor& sensor : sensors) all.push_back(&sensor);
  FusedMotion out;
  out.fused = estimate_any(time_s, all, options);
  for (const AxisSensor* sensor : all) {
    out.single.push_back(sensors.size() == 1 ? out.fused : estimate_any(time_s, {sensor}, options));
  }
  out.position_gain = gain(out, &AxisMotion::position_std_m);
  out.velocity_gain = gain(out, &AxisMotion::velocity_std_mps);
  out.accel_gain = gain(out, &AxisMotion::accel_std_mps2);
  return out;
}

}  // namespace proofmass::estimate
