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

/// One sensor's samples, averaged over `each` epochs; a mean with a missing sample is missing.
WheelSensor sensor_of(const std::vector<LiveEpoch>& epochs,
                      std::size_t index,
                      const Triad& channels,
                      std::size_t each) {
  WheelSensor sensor;
  sensor.name = channels.name;
  const std::size_t axes = channels.z ? 3 : 2;
  for (std::size_t first = 0; first + each <= epochs.size(); first += each) {
    double time_s = 0.0;
    Mat<3> force = Mat<3>::Zero();
    for (std::size_t k = first; k < first + each; ++k) {
      time_s += (epochs[k].time_s - epochs[first].time_s) / static_cast<double>(each);
      force += epochs[k].vectors[index] / static_cast<double>(each);
    }
    sensor.time_s.push_back(epochs[first].time_s + time_s);
    for (std::size_t axis = 0; axis < axes; ++axis)
      sensor.accel_mps2[axis].push_back(force(static_cast<Eigen::Index>(axis)));
  }
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

Result<LiveWheelStart> find_wheel(const std::vector<LiveEpoch>& epochs,
                                  const LiveWheelOptions& options) {
  const std::size_t count = options.sensors.size();
  if (epochs.size() < 10)
    return Error{Errc::too_few_samples, "fewer than 10 samples to find a wheel in"};
  const double rate_hz = rate_of(epochs);
  const auto each = static_cast<std::size_t>(std::max(1.0, std::ceil(rate_hz / seek_rate_hz)));
  std::vector<WheelSensor> sensors;
  for (std::size_t s = 0; s < count; ++s)
    sensors.push_back(sensor_of(epochs, s, options.sensors[s], each));
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
  for (const Single& single : pair.singles) start.planes.push_back(single.prepared.plane);
  start.gravity_mps2 = joint.readings.gravity_mps2;
  start.rolling_radius_m = joint.readings.rolling_radius_m.value;
  start.phase_rad = joint.readings.phase_rad;
  start.delay_s = joint.readings.delay_s;
  start.noise = joint.fit.track.noise;
  for (std::size_t s = 0; s < count; ++s)
    start.variance_m2ps4[s] =
        static_cast<double>(each) * *median(joint.readings.sensors[s].variance_m2ps4);
  start.constants = joint.fit.constants;
  if (!joint.readings.shakes) start.constants_cov = joint.fit.constants_cov;
  const auto places = static_cast<Eigen::Index>(2 * count);
  start.places_cov = joint.fit.constants_cov.bottomRightCorner(places, places);
  start.whole_turn = std::abs(joint.fit.turns.value) >= 1.0;
  start.prior.beginning = {joint.fit.series.angle_rad.front(), 0.2,
                           joint.fit.series.speed_radps.front(), 1.0};
  if (!start.whole_turn) start.prior.spread = short_way_prior;
  start.prior.places = places_in(joint.fit, count);
  start.notes = notes_of(sensors, pair, options.wheel);
  return start;
}

}  // namespace proofmass::estimate
