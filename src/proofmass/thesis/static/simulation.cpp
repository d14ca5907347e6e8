#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/simulate/running_rig.hpp"
#include "proofmass/thesis/means.hpp"
#include "proofmass/thesis/static_bias.hpp"

namespace proofmass::thesis {
namespace {

using simulate::RigOptions;
using simulate::RigSensor;
using simulate::RunningRig;

constexpr double rate_hz = 1000.0;
constexpr std::size_t decimation = 25;
constexpr double milli_g = 1e-3 * standard_gravity_mps2;

// Table 4.1, in m/s² and s; the other axes start where table 5.1 has their bias.
constexpr double a1_mps2 = 0.25, time_constant_s = 70.0;
constexpr std::array<std::array<double, 2>, 2> a2_mps2{
    {{-19.78 * milli_g, -0.21}, {19.56 * milli_g, 22.38 * milli_g}}};

// What low-cost sensors have: the Allan deviation turns up at some 40 s.
constexpr double random_walk_mps2_rts = 5e-3 * milli_g;

RigSensor sensor_at_rest(std::size_t number) {
  const auto& sheet = sensor::adxl335;
  constexpr double filter_f = 0.1e-6;
  RigSensor one;
  one.bias_mps2 = {a2_mps2[number][0], a2_mps2[number][1], 0.0};
  one.warm_up_mps2 = {a1_mps2, a1_mps2, 0.0};
  one.warm_up_time_s = time_constant_s;
  one.noise_rms_mps2 = {};
  one.noise_density_mps2_rthz = sheet.noise_density_mps2_rthz;
  one.bandwidth_hz = sensor::filter_bandwidth_hz(sheet, filter_f);
  one.bias_walk_mps2_rts = {random_walk_mps2_rts, random_walk_mps2_rts, 0.0};
  return one;
}

RigOptions rig_at_rest(std::uint64_t seed, double duration_s) {
  RigOptions options;
  options.seed = seed;
  options.rate_hz = rate_hz;
  options.axes = 2;
  options.bias_spread_mps2 = 0.0;
  options.wheel.profile = {{.duration_s = duration_s, .speed_radps = 0.0}};
  options.wheel.ripple = {};
  // The wheel lies flat: x and y are level, as section 3.3 wants them.
  options.wheel.axle_tilt_rad = std::numbers::pi / 2;
  options.sensors = {sensor_at_rest(0), sensor_at_rest(1)};
  return options;
}

std::vector<StaticAxis> axes_at_rest(std::size_t values) {
  std::vector<StaticAxis> axes;
  for (const std::size_t sensor : {0U, 1U}) {
    for (const std::size_t axis : {0U, 1U}) {
      StaticAxis& one = axes.emplace_back(StaticAxis{
          .name = std::string(1, "xy"[axis]) + std::to_string(sensor + 1), .accel_mps2 = {}});
      one.true_warm_up = {
          .a1_mps2 = a1_mps2, .a2_mps2 = a2_mps2[sensor][axis], .time_constant_s = time_constant_s};
      one.accel_mps2.reserve(values);
      one.picked_mps2.reserve(values);
      one.true_bias_mps2.reserve(values);
    }
  }
  return axes;
}

void append(const std::vector<double>& more, std::vector<double>& values) {
  values.insert(values.end(), more.begin(), more.end());
}

}  // namespace

Result<StaticRecord> simulate_static(std::uint64_t seed,
                                     const Progress& progress,
                                     double duration_s) {
  constexpr std::size_t piece = 400;     // means at a time
  constexpr std::size_t first_bias = 3;  // of the truth's channels
  auto started = RunningRig::start(rig_at_rest(seed, duration_s));
  if (!started) return started.error();
  RunningRig rig = std::move(started).value();
  const auto values = static_cast<std::size_t>(rig.profile_scans()) / decimation;
  StaticRecord record{.source = "simulated",
                      .simulated = true,
                      .rate_hz = rate_hz / decimation,
                      .decimation = decimation,
                      .since_switch_on_s = 0.5 * (decimation - 1) / rate_hz,
                      .axes = axes_at_rest(values)};
  RunningRig::Columns recorded, truth;
  for (std::size_t done = 0; done < values;) {
    const std::size_t now = std::min(piece, values - done);
    for (std::vector<double>& column : recorded) column.clear();
    for (std::vector<double>& column : truth) column.clear();
    rig.run(now * decimation, recorded, &truth);
    for (std::size_t c = 0; c < record.axes.size(); ++c) {
      StaticAxis& axis = record.axes[c];
      append(means_over(recorded[c], decimation), axis.accel_mps2);
      append(means_over(truth[first_bias + c], decimation), axis.true_bias_mps2);
      for (std::size_t k = 0; k < recorded[c].size(); k += decimation)
        axis.picked_mps2.push_back(recorded[c][k]);
    }
    done += now;
    if (progress)
      progress("simulating the test at rest",
               static_cast<double>(done) / static_cast<double>(values));
  }
  return record;
}

}  // namespace proofmass::thesis
