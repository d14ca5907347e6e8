#include "proofmass/estimate/wheel/gyro_jerk.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

constexpr double apart_s = 0.02;
/// A second difference within this many standard deviations may be noise.
constexpr double most_std = 5.0;

}  // namespace

GyroJerk::GyroJerk(double rate_hz, double noise_variance)
    : apart_(static_cast<std::size_t>(std::max(1.0, std::round(apart_s * rate_hz)))),
      noise2_(6.0 * square(most_std) * noise_variance),
      last_(2 * apart_ + 1) {
  PM_EXPECTS(rate_hz > 0.0);
  const double h = static_cast<double>(apart_) / rate_hz;
  per_square_ = 1.5 / (h * h * h);
  span_s_ = 2.0 * h;
  decay_ = std::exp(-0.5 / static_cast<double>(apart_));
}

double GyroJerk::add(double speed_radps) {
  psd_ *= decay_;
  if (std::isnan(speed_radps)) {
    count_ = 0;
    mean_accel_radps2_ = 0.0;
    return psd_;
  }
  const std::size_t size = last_.size(), at = count_ % size;
  last_[at] = speed_radps;
  if (++count_ < size) return psd_;
  const double first = last_[(at + 1) % size], middle = last_[(at + size - apart_) % size];
  mean_accel_radps2_ = (speed_radps - first) / span_s_;
  const double second = speed_radps - 2.0 * middle + first;
  psd_ = std::max(psd_, per_square_ * std::max(second * second - noise2_, 0.0));
  return psd_;
}

void mark_jerks(WheelReadings& readings) {
  const double rate_hz = readings.rate_hz();
  if (!(rate_hz > 0.0)) return;
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    const PlanarReadings& sensor = readings.sensors[s];
    if (sensor.speed_radps.empty()) continue;
    GyroJerk jerk(rate_hz, sensor.speed_scatter2);
    constexpr double gap_steps = 2.5;
    double last_s = readings.time_s.empty() ? 0.0 : readings.time_s.front();
    for (std::size_t k = 0; k < readings.epochs.size(); ++k) {
      WheelEpoch& epoch = readings.epochs[k];
      if (epoch.row[s] == WheelEpoch::no_row) continue;
      // Across a gap the speed changes by more than jerk between samples.
      if ((readings.time_s[k] - last_s) * rate_hz > gap_steps)
        static_cast<void>(jerk.add(no_value));
      last_s = readings.time_s[k];
      epoch.jerk_psd = std::max(
          epoch.jerk_psd, jerk.add(sensor.speed_radps[static_cast<std::size_t>(epoch.row[s])]));
    }
  }
}

}  // namespace proofmass::estimate
