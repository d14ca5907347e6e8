#include "proofmass/thesis/wheel/first_turn.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/thesis/wheel/axes.hpp"
#include "proofmass/thesis/wheel/first_revolution.hpp"
#include "proofmass/thesis/wheel/pass.hpp"

namespace proofmass::thesis {
namespace {

using estimate::WheelSensor;
using estimate::WheelSeries;
using estimate::WheelSolution;

constexpr std::size_t most_samples = 20000;

std::vector<WheelSensor> beginning_of(std::vector<WheelSensor> sensors) {
  for (WheelSensor& sensor : sensors) {
    const std::size_t kept = std::min(sensor.time_s.size(), most_samples);
    sensor.time_s.resize(kept);
    for (std::vector<double>& axis : sensor.accel_mps2)
      if (!axis.empty()) axis.resize(kept);
  }
  return sensors;
}

/// Values over ascending times at other times, straight between.
std::vector<double> at_times(const std::vector<double>& at_s,
                             const std::vector<double>& time_s,
                             const std::vector<double>& values,
                             double factor = 1.0) {
  std::vector<double> out(at_s.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    while (k + 2 < time_s.size() && time_s[k + 1] <= at_s[i]) ++k;
    const double share = (at_s[i] - time_s[k]) / (time_s[k + 1] - time_s[k]);
    // A missing value affects only its own sample.
    out[i] = share <= 0.0   ? values[k]
             : share >= 1.0 ? values[k + 1]
                            : values[k] + share * (values[k + 1] - values[k]);
    out[i] *= factor;
  }
  return out;
}

/// The wheel model's angle at the first sensor's samples, of that sensor's place and the way the
/// wheel turns positive.
AngleEstimate angle_at(const std::vector<double>& at_s,
                       const std::vector<double>& time_s,
                       const AngleEstimate& angle,
                       const WheelGeometry& geometry) {
  AngleEstimate out{at_times(at_s, time_s, angle.angle_rad, geometry.sense),
                    at_times(at_s, time_s, angle.std_rad)};
  for (double& value : out.angle_rad) value -= geometry.turned_rad[0];
  return out;
}

void take_estimates(const WheelSeries& series, const WheelGeometry& geometry, FirstTurn& turn) {
  turn.filtered = angle_at(turn.time_s, series.time_s,
                           {series.filtered_angle_rad, series.filtered_angle_std_rad}, geometry);
  turn.smoothed =
      angle_at(turn.time_s, series.time_s, {series.angle_rad, series.angle_std_rad}, geometry);
  turn.smoothed_accel_radps2 =
      at_times(turn.time_s, series.time_s, series.accel_radps2, geometry.sense);
}

void take_truth(const WheelRecord& record, FirstTurn& turn) {
  turn.angle_rad = record.true_angle_rad;
  turn.speed_radps = record.true_speed_radps;
  turn.accel_radps2 = record.true_accel_radps2;
}

/// Time stamps of a sensor as estimated by the wheel model.
struct SensorClock {
  std::array<double, 3> spin_axis{0.0, 0.0, 1.0};
  double late_s = 0.0;  ///< its stamps, against the first sensor's
};

/// Along outward and forward, from x and y.
std::array<KnownBias, 2> turned(const std::array<KnownBias, 2>& bias, double turned_rad) {
  const double c = std::cos(turned_rad), s = std::sin(turned_rad);
  const auto mixed = [&](double along_x, double along_y) {
    KnownBias out = bias[0];
    out.start_mps2.value = along_x * bias[0].start_mps2.value + along_y * bias[1].start_mps2.value;
    out.start_mps2.std =
        std::hypot(along_x * bias[0].start_mps2.std, along_y * bias[1].start_mps2.std);
    out.rise_mps2 = along_x * bias[0].rise_mps2 + along_y * bias[1].rise_mps2;
    return out;
  };
  return {mixed(c, -s), mixed(s, c)};
}

/// All but the estimates.
FirstTurn readings_of(const WheelRecord& record,
                      const std::vector<WheelSensor>& sensors,
                      const WheelGeometry& geometry,
                      const std::vector<SensorClock>& clocks) {
  FirstTurn turn{.source = record.source,
                 .simulated = record.simulated,
                 .set_speed_radps = std::abs(record.speed_radps),
                 .time_s = sensors.front().time_s,
                 .opposite = geometry.opposite,
                 .radius_m = record.radius_m,
                 .notes = geometry.notes};
  if (record.sensors.front().time_s.size() > most_samples)
    turn.notes.push_back(record.source + ": only its first 20 000 samples are used");
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    auto force =
        outward_forward(sensors[s], clocks[s].spin_axis, geometry.turned_rad[s], geometry.sense);
    if (clocks[s].late_s != 0.0 || sensors[s].time_s != turn.time_s) {
      std::vector<double> time_s = sensors[s].time_s;
      for (double& t : time_s) t -= clocks[s].late_s;
      for (auto& axis : force) axis = at_times(turn.time_s, time_s, axis);
    }
    turn.force_mps2.push_back(std::move(force));
    if (!record.bias.empty())
      turn.bias.push_back(turned(record.bias[s], geometry.turned_rad[s]));
    else
      turn.bias.emplace_back();
  }
  return turn;
}

}  // namespace

std::optional<std::size_t> FirstTurn::sample_at(double t_s) const {
  const auto after = std::ranges::lower_bound(time_s, t_s - 1e-9);
  if (after == time_s.end()) return std::nullopt;
  return static_cast<std::size_t>(after - time_s.begin());
}

std::vector<double> FirstTurn::path_m(const std::vector<double>& angle) const {
  std::vector<double> path;
  if (!radius_m) return path;
  path.reserve(angle.size());
  for (const double a : angle) path.push_back(*radius_m * (a - angle.front()));
  return path;
}

Result<FirstTurn> first_turn(const WheelRecord& record, double gravity_mps2) {
  const std::vector<WheelSensor> sensors = beginning_of(record.sensors);
  estimate::WheelOptions options;
  options.gravity_mps2 = gravity_mps2;
  options.radius_m = record.radius_m;
  options.clocks_shared = record.clocks_shared;
  const Result<WheelSolution> solution = estimate::estimate_wheel(sensors, options);
  if (!solution) return Error(solution.error()).at(record.source);
  std::vector<SensorClock> clocks;
  for (const auto& sensor : solution->sensors)
    clocks.push_back({sensor.spin_axis,
                      record.simulated ? 0.0 : sensor.clock_offset_s.value_or(Uncertain{}).value});
  const WheelGeometry geometry = geometry_of(record, *solution);
  FirstTurn turn = readings_of(record, sensors, geometry, clocks);
  turn.gravity_mps2 = gravity_mps2;
  turn.noise_mps2 = solution->sensors.front().noise_mps2;
  if (!turn.radius_m && solution->sensors.front().radius_m)
    turn.radius_m = solution->sensors.front().radius_m->value;
  const WheelSeries& series = solution->series;
  take_estimates(series, geometry, turn);
  if (record.simulated) {
    take_truth(record, turn);
  } else {
    turn.angle_rad = turn.smoothed.angle_rad;
    turn.speed_radps = at_times(turn.time_s, series.time_s, series.speed_radps, geometry.sense);
    turn.accel_radps2 = turn.smoothed_accel_radps2;
    turn.start_speed_std_radps = series.speed_std_radps.front();
  }
  cut_to_first_revolution(turn);
  if (turn.size() < 10 || turn.angle_rad.back() - turn.angle_rad.front() < 0.1)
    return Error{Errc::too_few_samples, "the wheel hardly turns"}.at(record.source);
  return turn;
}

FirstTurn first_turn(const RigRun& run, const WheelRecord& record) {
  const WheelPass pass = wheel_pass(run, record);
  const WheelGeometry geometry = rig_geometry();
  FirstTurn turn = readings_of(record, record.sensors, geometry, {2, SensorClock{}});
  turn.gravity_mps2 = run.gravity_mps2;
  turn.noise_mps2 = rig_noise_mps2();
  turn.filtered = angle_at(turn.time_s, pass.time_s, pass.filtered, geometry);
  turn.smoothed = angle_at(turn.time_s, pass.time_s, pass.smoothed, geometry);
  turn.smoothed_accel_radps2 = at_times(turn.time_s, pass.time_s, pass.smoothed_accel_radps2);
  turn.moved_std_rad = at_times(turn.time_s, pass.time_s, pass.moved_std_rad);
  take_truth(record, turn);
  cut_to_first_revolution(turn);
  return turn;
}

std::optional<FusedReading> fuse(const FirstTurn& turn, WheelAxis axis, Fusion how) {
  const bool pair = turn.force_mps2.size() == 2 && turn.opposite;
  if (how == Fusion::gravity_cancelled && !pair) return std::nullopt;
  const auto along = static_cast<std::size_t>(axis);
  const double sign = how == Fusion::gravity_cancelled ? -1.0 : 1.0;
  const KnownBias& first = turn.bias[0][along];
  FusedReading fused{.time_s = turn.time_s,
                     .accel_mps2 = turn.force_mps2[0][along],
                     .variance_m2ps4 = turn.noise_mps2 * turn.noise_mps2,
                     .bias_mps2 = first.start_mps2,
                     .bias_rise_mps2 = first.rise_mps2,
                     .time_constant_s = first.time_constant_s,
                     .start_speed_mps = {}};
  const double radius_m = turn.radius_m.value_or(0.0);
  fused.start_speed_mps = {radius_m * turn.speed_radps.front(),
                           radius_m * turn.start_speed_std_radps};
  if (!pair) return fused;
  const KnownBias& second = turn.bias[1][along];
  for (std::size_t k = 0; k < fused.accel_mps2.size(); ++k)
    fused.accel_mps2[k] = 0.5 * (fused.accel_mps2[k] + sign * turn.force_mps2[1][along][k]);
  fused.variance_m2ps4 /= 2.0;
  fused.bias_mps2 = {0.5 * (first.start_mps2.value + sign * second.start_mps2.value),
                     0.5 * std::hypot(first.start_mps2.std, second.start_mps2.std)};
  fused.bias_rise_mps2 = 0.5 * (first.rise_mps2 + sign * second.rise_mps2);
  return fused;
}

}  // namespace proofmass::thesis
