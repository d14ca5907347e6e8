#include "proofmass/estimate/wheel/gyro_jerk.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/contract.hpp"

namespace proofmass::estimate {
namespace {

constexpr double apart_s = 0.02;
/// A second difference within this many standard deviations may be noise.
constexpr double most_std = 5.0;

}  // namespace

GyroJerk::GyroJerk(double rate_hz, double noise_variance, Evidence evidence)
    : rate_hz_(rate_hz),
      evidence_(evidence),
      apart_(static_cast<std::size_t>(std::max(1.0, std::round(apart_s * rate_hz)))),
      noise2_(6.0 * square(most_std) * noise_variance),
      last_(2 * apart_ + 1, no_value) {
  PM_EXPECTS(rate_hz > 0.0);
  const double h = static_cast<double>(apart_) / rate_hz;
  per_square_ = 1.5 / (h * h * h);
  decay_ = std::exp(-0.5 / static_cast<double>(apart_));
}

void GyroJerk::put(double speed_radps) {
  const std::size_t size = last_.size();
  last_[at_] = speed_radps;
  at_ = (at_ + 1) % size;
  psd_ *= decay_;
  const double first = last_[at_], middle = last_[(at_ + apart_) % size];
  const double second = speed_radps - 2.0 * middle + first;
  const double before = std::exchange(second_, second);
  if (std::isnan(second)) return;
  double least2 = second * second;
  if (evidence_ == Evidence::two && apart_ > 1 && !std::isnan(before))
    least2 = before * second > 0.0 ? std::min(least2, before * before) : 0.0;
  psd_ = std::max(psd_, per_square_ * std::max(least2 - noise2_, 0.0));
}

double GyroJerk::add(double time_s, double speed_radps) {
  const double steps = std::round((time_s - last_s_) * rate_hz_);  // NaN at first
  const double most = static_cast<double>(last_.size());
  for (double lost = std::min(steps - 1.0, most); lost > 0.0; lost -= 1.0) put(no_value);
  last_s_ = time_s;
  put(speed_radps);
  return psd_;
}

void mark_jerks(WheelReadings& readings) {
  const double rate_hz = readings.rate_hz();
  if (!(rate_hz > 0.0)) return;
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    const PlanarReadings& sensor = readings.sensors[s];
    if (sensor.speed_radps.empty()) continue;
    GyroJerk jerk(rate_hz, sensor.speed_scatter2);
    for (std::size_t k = 0; k < readings.epochs.size(); ++k) {
      WheelEpoch& epoch = readings.epochs[k];
      if (epoch.row[s] == WheelEpoch::no_row) continue;
      const double speed_radps = sensor.speed_radps[static_cast<std::size_t>(epoch.row[s])];
      epoch.jerk_psd = std::max(epoch.jerk_psd, jerk.add(readings.time_s[k], speed_radps));
    }
  }
}

}  // namespace proofmass::estimate
