#include "proofmass/thesis/wheel/rig.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::thesis {
namespace {

constexpr double mg = 1e-3 * standard_gravity_mps2;

// Evenly within ±, of the rms of table 5.1's 19.68 and 22.29 mg.
const double bias_spread_mps2 = std::numbers::sqrt3 * 21.0 * mg;

// Between a tumble test and a run on another day: 1 mg/K (datasheet) and 2 K.
constexpr double known_bias_std_mps2 = 2.0 * mg;

// Table 4.1, its figures taken as m/s² and s: −0.21 m/s² is −21.4 mg, the bias of table 5.1.
constexpr double warm_up_mps2 = 0.25;
constexpr double warm_up_time_s = 70.0;

constexpr double axle_tilt_rad = 0.5 * rad_per_deg;

simulate::RigSensor adxl335_at(double position_rad) {
  simulate::RigSensor sensor;
  sensor.radius_m = rig_radius_m;
  sensor.position_rad = position_rad;
  sensor.mounting_rad = position_rad;
  sensor.noise_rms_mps2 = {};
  sensor.noise_density_mps2_rthz = sensor::adxl335.noise_density_mps2_rthz;
  sensor.bandwidth_hz = rig_bandwidth_hz;
  sensor.warm_up_mps2 = {warm_up_mps2, warm_up_mps2, warm_up_mps2};
  sensor.warm_up_time_s = warm_up_time_s;
  return sensor;
}

simulate::RigOptions rig_of(const RigRun& run) {
  simulate::RigOptions options;
  options.seed = run.seed;
  options.rate_hz = rig_rate_hz;
  options.gravity_mps2 = run.gravity_mps2;
  options.axes = 2;
  options.bias_spread_mps2 = bias_spread_mps2;
  options.datasheet_errors = run.datasheet_errors;
  options.sensors = {adxl335_at(0.0), adxl335_at(std::numbers::pi)};
  options.wheel.start_angle_rad = Random(run.seed, "angle at which the wheel starts").phase();
  options.wheel.ripple = {.fraction = rig_ripple};
  options.wheel.axle_tilt_rad = run.datasheet_errors ? axle_tilt_rad : 0.0;
  options.wheel.profile = {
      {.duration_s = ramp_s / 2.0 + run.turns * rad_per_turn / std::abs(run.speed_radps),
       .speed_radps = run.speed_radps,
       .ramp_s = ramp_s}};
  return options;
}

KnownBias known_beforehand(double true_bias_mps2, Random& random) {
  return {
      .start_mps2 = {true_bias_mps2 + known_bias_std_mps2 * random.normal(), known_bias_std_mps2},
      .rise_mps2 = warm_up_mps2,
      .time_constant_s = warm_up_time_s};
}

}  // namespace

double rig_noise_mps2() {
  return sensor::filtered_noise_rms(sensor::adxl335.noise_density_mps2_rthz[0], rig_bandwidth_hz);
}

Result<WheelRecord> simulate_wheel(const RigRun& run) {
  Result<simulate::RigResult> simulated = simulate::simulate_rig(rig_of(run));
  if (!simulated) return simulated.error();
  simulate::RigResult rig = std::move(simulated).value();
  Recording& recording = rig.recording;
  WheelRecord record{.source = "simulated",
                     .simulated = true,
                     .sensors = {},
                     .radius_m = rig_radius_m,
                     .speed_radps = run.speed_radps};
  std::vector<double> time_s(recording.samples());
  for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = recording.time.at(k);
  Random random(run.seed, "error of the known bias");
  for (std::size_t s = 0; s < 2; ++s) {
    record.sensors.push_back({.name = "acc" + std::to_string(s + 1),
                              .time_s = time_s,
                              .accel_mps2 = {std::move(recording.channels[2 * s].values).take(),
                                             std::move(recording.channels[2 * s + 1].values).take(),
                                             {}}});
    auto& known = record.bias.emplace_back();
    for (std::size_t axis = 0; axis < 2; ++axis)
      known[axis] = known_beforehand(rig.truth.channels[3 + 2 * s + axis].values.front(), random);
  }
  record.true_angle_rad = std::move(rig.truth.channels[0].values).take();
  record.true_speed_radps = std::move(rig.truth.channels[1].values).take();
  record.true_accel_radps2 = std::move(rig.truth.channels[2].values).take();
  return record;
}

}  // namespace proofmass::thesis
