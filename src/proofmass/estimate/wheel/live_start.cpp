#include "proofmass/estimate/wheel/live_start.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/joint_fit.hpp"

namespace proofmass::estimate {
namespace {

/// Maximum rate of the initialisation: sufficient for the fastest wheel.
constexpr double seek_rate_hz = 200.0;

double rate_of(const std::vector<LiveEpoch>& epochs) {
  const double span_s = epochs.back().time_s - epochs.front().time_s;
  return static_cast<double>(epochs.size() - 1) / span_s;
}

/// A vector's means over `each` epochs, along its first axes; a mean with a missing sample is NaN.
void append_means(const std::vector<LiveEpoch>& epochs,
                  std::size_t vector,
                  std::size_t each,
                  std::size_t axes,
                  std::array<std::vector<double>, 3>& out) {
  for (std::size_t first = 0; first + each <= epochs.size(); first += each) {
    Mat<3> mean = Mat<3>::Zero();
    for (std::size_t k = first; k < first + each; ++k)
      mean += epochs[k].vectors[vector] / static_cast<double>(each);
    for (std::size_t axis = 0; axis < axes; ++axis)
      out[axis].push_back(mean(static_cast<Eigen::Index>(axis)));
  }
}

/// One sensor's samples, averaged over `each` epochs.
WheelSensor sensor_of(const std::vector<LiveEpoch>& epochs,
                      const LiveWheelOptions& options,
                      std::size_t index,
                      std::size_t each) {
  WheelSensor sensor;
  sensor.name = options.sensors[index].name;
  for (std::size_t first = 0; first + each <= epochs.size(); first += each) {
    double time_s = 0.0;
    for (std::size_t k = first; k < first + each; ++k)
      time_s += (epochs[k].time_s - epochs[first].time_s) / static_cast<double>(each);
    sensor.time_s.push_back(epochs[first].time_s + time_s);
  }
  append_means(epochs, index, each, options.sensors[index].z ? 3 : 2, sensor.accel_mps2);
  if (const auto rates = gyroscope_at(options, index))
    append_means(epochs, *rates, each, 3, sensor.rate_radps);
  return sensor;
}

std::vector<Note> notes_of(const std::vector<WheelSensor>& sensors,
                           const Pair& pair,
                           const WheelOptions& options) {
  std::vector<Note> notes;
  for (std::size_t s = 0; s < sensors.size(); ++s)
    if (pair.singles[s].prepared.plane.assumed && !options.spin_axis)
      notes.push_back({Severity::warning,
                       sensors[s].name +
                           ": the wheel hardly turns yet: took the most level of the sensor's axes "
                           "for its axle; it is found once the wheel has turned round",
                       {Advice{"spin-axis"}}});
  return notes;
}

}  // namespace

std::optional<std::size_t> gyroscope_at(const LiveWheelOptions& options, std::size_t sensor) {
  if (sensor >= options.gyroscopes.size() || !options.gyroscopes[sensor].x) return std::nullopt;
  std::size_t at = options.sensors.size();
  for (std::size_t s = 0; s < sensor; ++s)
    if (options.gyroscopes[s].x) ++at;
  return at;
}

Result<LiveWheelStart> find_wheel(const std::vector<LiveEpoch>& epochs,
                                  const LiveWheelOptions& options) {
  const std::size_t count = options.sensors.size();
  if (epochs.size() < 10)
    return Error{Errc::too_few_samples, "fewer than 10 samples to find a wheel in"};
  const double rate_hz = rate_of(epochs);
  const auto each = static_cast<std::size_t>(std::max(1.0, std::ceil(rate_hz / seek_rate_hz)));
  std::vector<WheelSensor> sensors;
  for (std::size_t s = 0; s < count; ++s) sensors.push_back(sensor_of(epochs, options, s, each));
  WheelOptions wheel = options.wheel;
  wheel.clocks_shared = true;
  wheel.radius_m.reset();  // used better by the filter itself
  auto singles = fit_singles(sensors, wheel);
  if (!singles) return singles.error();
  Pair pair = std::move(singles).value();
  pair.clocks.offset_s.value = 0.0;  // the epochs are both sensors'
  Joint joint;
  if (count == 2)
    joint = fit_jointly(sensors, pair, wheel);
  else
    joint = {std::move(pair.singles[0].readings), std::move(pair.singles[0].fit)};
  LiveWheelStart start;
  start.rate_hz = rate_hz;
  for (const Single& single : pair.singles) start.planes.push_back(single.prepared.plane);
  start.gravity_mps2 = joint.readings.gravity_mps2;
  start.rolling_radius_m = joint.readings.rolling_radius_m.value;
  start.phase_rad = joint.readings.phase_rad;
  start.delay_s = joint.readings.delay_s;
  start.noise = joint.fit.track.noise;
  for (std::size_t s = 0; s < count; ++s) {
    const PlanarReadings& readings = joint.readings.sensors[s];
    start.variance_m2ps4[s] = static_cast<double>(each) * *median(readings.variance_m2ps4);
    start.speed_variance[s] = static_cast<double>(each) * readings.speed_variance;
    start.speed_scatter2[s] = static_cast<double>(each) * readings.speed_scatter2;
    start.leak_u[s] = readings.leak_u;
    start.leak_v[s] = readings.leak_v;
  }
  start.constants = joint.fit.constants;
  if (!joint.readings.shakes) start.constants_cov = joint.fit.constants_cov;
  const auto places = static_cast<Eigen::Index>(2 * count);
  start.places_cov = joint.fit.constants_cov.bottomRightCorner(places, places);
  start.whole_turn = std::abs(joint.fit.turns.value) >= 1.0;
  start.prior.beginning = {joint.fit.series.angle_rad.front(), 0.2,
                           joint.fit.series.speed_radps.front(), 1.0};
  start.orders = joint.readings.orders;
  start.with_ripple = start.whole_turn && !joint.readings.shakes;
  start.prior.spread = start.whole_turn ? ConstantsPrior{} : short_way_prior;
  if (start.with_ripple) start.prior.spread.ripple = ripple_share;
  start.prior.spread.rolling_m = rolling_prior_std_m(joint.readings, false);
  for (std::size_t s = 0; s < count; ++s)
    start.prior.spread.axle_slopes[s] = joint.readings.sensors[s].axle_slope;
  start.prior.places = places_in(joint.fit, count);
  start.notes = notes_of(sensors, pair, options.wheel);
  return start;
}

}  // namespace proofmass::estimate
