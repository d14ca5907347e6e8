#include "proofmass/estimate/track_pva.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/fusion.hpp"
#include "proofmass/estimate/track_jerk.hpp"
#include "proofmass/estimate/track_pva_pass.hpp"
#include "proofmass/estimate/track_walk.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::estimate {
namespace {

// One accelerometer along the axis.
struct SensorAlong {
  std::string name;
  std::vector<double> accel_mps2;  // less its level at the first rest
  double level_mps2 = 0.0;
  double white_m2ps3 = 0.0, walk_m2ps5 = 0.0;
  std::optional<double> warm_up_time_s;

  [[nodiscard]] PvaSensor reading(double rate_hz) const {
    return {accel_mps2, white_m2ps3 * rate_hz, walk_m2ps5, warm_up_time_s};
  }
};

// Along an axis between those of the sensor, the warm-up of its largest component counts.
std::optional<double> warm_up_along(const std::array<std::optional<double>, 3>& time_s,
                                    const std::array<double, 3>& axis) {
  const auto largest = std::max_element(
      axis.begin(), axis.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  return time_s[static_cast<std::size_t>(largest - axis.begin())];
}

SensorAlong first_along(const PvaTask& task, const TrackOptions& options, const TrackSolution& of) {
  SensorAlong first{.name = task.sensor.name,
                    .accel_mps2 = of.series.accel_mps2,
                    .white_m2ps3 = task.run.noise.white_m2ps3,
                    .walk_m2ps5 = task.run.noise.rest_walk_m2ps5,
                    .warm_up_time_s = warm_up_along(options.warm_up_time_s, of.axis)};
  for (std::size_t a = 0; a < task.signal.axes.size(); ++a)
    first.level_mps2 += of.axis[task.signal.axes[a]] * task.signal.reference_mps2[a];
  return first;
}

Result<std::vector<double>> project(const ParallelAccelerometer& sensor,
                                    const std::array<double, 3>& axis,
                                    std::size_t size) {
  std::vector<double> along(size, 0.0);
  for (std::size_t a = 0; a < 3; ++a) {
    if (axis[a] == 0.0) continue;
    const std::vector<double>& accel = sensor.accel_mps2[a];
    if (accel.empty())
      return Error{Errc::invalid_argument,
                   "the axis of the motion points where this sensor has none; --axis gives one "
                   "that all have"};
    if (accel.size() != size)
      return Error{Errc::invalid_argument, "its readings are not as many as the first one's"};
    for (std::size_t k = 0; k < size; ++k)
      along[k] = signal::is_plausible(accel[k]) ? along[k] + axis[a] * accel[k] : std::nan("");
  }
  return along;
}

Result<SensorAlong> beside_along(const PvaTask& task,
                                 const ParallelAccelerometer& sensor,
                                 const std::array<double, 3>& axis) {
  auto projected = project(sensor, axis, task.signal.time_s.size());
  if (!projected) return projected.error().at(sensor.name);
  SensorAlong one{.name = sensor.name,
                  .accel_mps2 = std::move(projected).value(),
                  .warm_up_time_s = warm_up_along(sensor.figures.warm_up_time_s, axis)};
  View<double> level_of = one.accel_mps2;
  if (!task.readings.rests.empty()) {
    const signal::Rest& rest = task.readings.rests.front();
    level_of = level_of.subspan(rest.first, rest.last - rest.first + 1);
  }
  const Moments level = moments(level_of);
  if (level.count == 0)
    return Error{Errc::too_few_samples, "no reading at the first rest"}.at(sensor.name);
  one.level_mps2 = level.mean;
  for (double& x : one.accel_mps2) x -= one.level_mps2;
  const AxisRun run = prepare_axis(task.signal, one.accel_mps2, task.readings,
                                   {density_along(sensor.figures.white_mps2_rthz, axis),
                                    density_along(sensor.figures.walk_mps2_rts, axis)});
  one.white_m2ps3 = run.noise.white_m2ps3;
  one.walk_m2ps5 = run.noise.rest_walk_m2ps5;
  return one;
}

std::string text(const char* format, double value) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

// In motion, parallel sensors read the same: the slope of one over the other is 1.
Status check_parallel(const SensorAlong& first,
                      const SensorAlong& other,
                      const std::vector<PvaSample>& samples,
                      double rate_hz) {
  double xx = 0.0, xy = 0.0, noise = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double x = first.accel_mps2[k], y = other.accel_mps2[k];
    if (samples[k].resting || std::isnan(x) || std::isnan(y)) continue;
    xx += x * x;
    xy += x * y;
    noise += first.white_m2ps3 * rate_hz;
  }
  const bool tells = xx > 30.0 * noise;
  if (!tells || (xy > 0.7 * xx && xy < 1.4 * xx)) return Done{};
  return Error{Errc::invalid_argument,
               text("along the axis of the motion it reads %.2f times what the first does: "
                    "sensors to be fused have parallel axes and the same scale",
                    xy / xx)}
      .at(other.name);
}

// A turn lies within a sample of where it is said to be.
double turn_std_mps(const PvaTask& task, View<double> accel, std::size_t k) {
  const double h = k > 0 ? task.signal.time_s[k] - task.signal.time_s[k - 1] : 0.0;
  const double slip_mps = std::isnan(accel[k]) ? 0.0 : std::abs(accel[k]) * h;
  return std::hypot(task.readings.rest_speed_std_mps, slip_mps);
}

std::vector<PvaSample> samples_of(const PvaTask& task, View<double> accel) {
  std::vector<PvaSample> samples(task.signal.time_s.size());
  for (const std::size_t k : task.readings.turns)
    samples[k].velocity_std_mps = turn_std_mps(task, accel, k);
  for (const TrackReadings::Fix& fix : task.readings.fixes) {
    PvaSample& at = samples[fix.sample];
    const double before = std::isnan(at.position_m) ? 0.0 : 1.0 / at.position_variance;
    const double weight = before + 1.0 / fix.variance_m2;
    const double sum =
        (before > 0.0 ? before * at.position_m : 0.0) + fix.position_m / fix.variance_m2;
    at.position_m = sum / weight;
    at.position_variance = 1.0 / weight;
  }
  for (const signal::Rest& rest : task.readings.rests) {
    samples[rest.first].velocity_std_mps = task.readings.rest_speed_std_mps;
    samples[rest.first].arrives = samples[rest.first].jumps = rest.first > 0;
    for (std::size_t k = rest.first + 1; k <= rest.last; ++k)
      samples[k] = {.resting = true,
                    .position_m = samples[k].position_m,
                    .position_variance = samples[k].position_variance};
    if (rest.last + 1 < samples.size()) samples[rest.last + 1].jumps = true;
  }
  return samples;
}

PvaNoise noise_of(const PvaTask& task, double jerk_psd) {
  const InertialNoise& noise = task.run.noise;
  return {.jerk_psd_m2ps5 = jerk_psd,
          .lean_m2ps3 = noise.motion_lean_m2ps3,
          .common_walk_m2ps5 = std::max(0.0, noise.motion_walk_m2ps5 - noise.rest_walk_m2ps5),
          .jump_m2ps4 = noise.motion_jump_m2ps4,
          .rest_speed_std_mps = task.readings.rest_speed_std_mps};
}

template <int S>
PvaAxis<S> axis_of(const PvaTask& task,
                   const std::vector<const SensorAlong*>& sensors,
                   const std::vector<PvaSample>& samples,
                   double jerk_psd) {
  std::vector<PvaSensor> readings;
  for (const SensorAlong* sensor : sensors)
    readings.push_back(sensor->reading(task.signal.rate_hz));
  PvaAxis<S> axis(task.signal.time_s, std::move(readings), samples);
  axis.noise = noise_of(task, jerk_psd);
  axis.longest_step_s = task.run.longest_step_s;
  return axis;
}

void take(PvaPass pass, TrackSolution& solution) {
  TrackSeries& series = solution.series;
  series.position_m = std::move(pass.smoothed.position_m);
  series.position_std_m = std::move(pass.smoothed.position_std_m);
  series.velocity_mps = std::move(pass.smoothed.velocity_mps);
  series.velocity_std_mps = std::move(pass.smoothed.velocity_std_mps);
  series.filtered_position_m = std::move(pass.filtered.position_m);
  series.filtered_position_std_m = std::move(pass.filtered.position_std_m);
  series.filtered_velocity_mps = std::move(pass.filtered.velocity_mps);
  for (auto* std : {&series.position_std_m, &series.filtered_position_std_m}) {
    const auto& of = std == &series.position_std_m ? series.position_m : series.filtered_position_m;
    for (std::size_t k = 0; k < of.size(); ++k)
      (*std)[k] = std::hypot((*std)[k], solution.scale_std * of[k]);
  }
  for (std::size_t k = 0; k < series.velocity_mps.size(); ++k)
    series.velocity_std_mps[k] =
        std::hypot(series.velocity_std_mps[k], solution.scale_std * series.velocity_mps[k]);
  solution.closures = std::move(pass.closures);
  solution.consistency = std::move(pass.consistency);
}

FusedSensor fused_sensor(const SensorAlong& sensor,
                         const PvaPass& alone,
                         const Uncertain& bias,
                         double scale_std) {
  const double end_m = alone.smoothed.position_m.back();
  return {sensor.name,
          {sensor.level_mps2 + bias.value, bias.std},
          {end_m, std::hypot(alone.smoothed.position_std_m.back(), scale_std * end_m)}};
}

struct Sensors {
  std::vector<SensorAlong> all;
  std::vector<PvaSample> samples;
};

// What all sensors err by in motion, told by how far their mean misses the stops.
struct CommonError {
  double share_std = 1.0;  // √Σw²: of errors that each sensor has for itself, one in the mean
  PvaNoise noise;
  MotionError figures;
};

CommonError common_error(const PvaTask& task,
                         const std::vector<SensorAlong>& sensors,
                         double jerk_psd) {
  CommonError found;
  double sum = 0.0, squares = 0.0;
  for (const SensorAlong& one : sensors) {
    sum += 1.0 / one.white_m2ps3;
    squares += 1.0 / (one.white_m2ps3 * one.white_m2ps3);
  }
  found.share_std = std::sqrt(squares) / sum;
  std::vector<double> mean(task.signal.time_s.size(), 0.0);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    double weights = 0.0;
    for (const SensorAlong& one : sensors) {
      if (std::isnan(one.accel_mps2[k])) continue;
      mean[k] += one.accel_mps2[k] / one.white_m2ps3;
      weights += 1.0 / one.white_m2ps3;
    }
    mean[k] /= weights;  // NaN where none reads
  }
  AxisRun run = prepare_axis(task.signal, mean, task.readings, {});
  found.figures = motion_error(join_epochs(run.made.epochs, run.made.knots), run.noise, run.start);
  run.noise.motion_walk_m2ps5 = found.figures.walk_m2ps5;
  run.noise.motion_jump_m2ps4 = found.figures.jump_m2ps4;
  run.noise.motion_lean_m2ps3 = found.figures.lean_m2ps3;
  found.noise = noise_of({task.sensor, task.signal, run, task.readings}, jerk_psd);
  return found;
}

void fuse(const PvaTask& task, const Sensors& sensors, double jerk_psd, TrackSolution& solution) {
  std::vector<const SensorAlong*> all;
  std::vector<std::string> names;
  for (const SensorAlong& one : sensors.all) {
    all.push_back(&one);
    names.push_back(one.name);
  }
  constexpr auto most = static_cast<int>(most_fused_sensors);
  const CommonError common = common_error(task, sensors.all, jerk_psd);
  auto axis = axis_of<most>(task, all, sensors.samples, jerk_psd);
  axis.noise = common.noise;
  PvaPass fused = pass_over(axis, {task.run.start.speed_std_mps, task.signal.rate_hz, names});
  FusedTrack track;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PvaPass alone =
        pass_over(axis_of<1>(task, {all[i]}, sensors.samples, jerk_psd),
                  {task.run.start.speed_std_mps, task.signal.rate_hz, {names[i]}});
    track.sensors.push_back(fused_sensor(*all[i], alone, fused.bias_mps2[i], solution.scale_std));
    best = std::min(best, track.sensors.back().displacement_m.std);
  }
  solution.scale_std *= common.share_std;  // each sensor's scale errs for itself
  take(std::move(fused), solution);
  solution.factor_95 = common.figures.factor_95;
  solution.motion_error = {std::sqrt(common.figures.walk_m2ps5),
                           std::sqrt(common.figures.jump_m2ps4),
                           std::sqrt(common.figures.lean_m2ps3)};
  const double std = solution.series.position_std_m.back();
  if (std > 0.0) track.variance_gain = best * best / (std * std);
  solution.fused = std::move(track);
}

Result<Sensors> sensors_of(const PvaTask& task,
                           const TrackOptions& options,
                           const TrackSolution& solution) {
  Sensors sensors;
  sensors.all.push_back(first_along(task, options, solution));
  sensors.samples = samples_of(task, solution.series.accel_mps2);
  if (options.model != TrackModel::fused) return sensors;
  const std::size_t beside = task.sensor.beside.size();
  if (beside == 0 || beside >= most_fused_sensors)
    return Error{Errc::invalid_argument, std::to_string(beside + 1) + " accelerometers; 2 to " +
                                             std::to_string(most_fused_sensors) + " are fused"};
  for (const ParallelAccelerometer& other : task.sensor.beside) {
    auto one = beside_along(task, other, solution.axis);
    if (!one) return one.error();
    const Status parallel =
        check_parallel(sensors.all.front(), *one, sensors.samples, task.signal.rate_hz);
    if (!parallel) return parallel.error();
    sensors.all.push_back(std::move(one).value());
  }
  return sensors;
}

}  // namespace

Status apply_track_model(const PvaTask& task,
                         const TrackOptions& options,
                         TrackSolution& solution) {
  if (options.model == TrackModel::inertial) return Done{};
  if (options.jerk_psd_m2ps5 && !(*options.jerk_psd_m2ps5 > 0.0))
    return Error{Errc::invalid_argument, "the density of the jerk must be positive"};
  auto made = sensors_of(task, options, solution);
  if (!made) return made.error();
  const Sensors sensors = std::move(made).value();
  PvaAxis<1> first = axis_of<1>(task, {&sensors.all.front()}, sensors.samples, 1.0);
  const double speed_std = task.run.start.speed_std_mps;
  const JerkDensity jerk = options.jerk_psd_m2ps5 ? JerkDensity{*options.jerk_psd_m2ps5, 0.0, true}
                                                  : likeliest_jerk(first, speed_std);
  solution.model = options.model;
  if (jerk.told) solution.jerk_psd_m2ps5 = Uncertain{jerk.psd_m2ps5, jerk.std_m2ps5};
  if (options.model == TrackModel::fused) {
    fuse(task, sensors, jerk.psd_m2ps5, solution);
    return Done{};
  }
  first.noise.jerk_psd_m2ps5 = jerk.psd_m2ps5;
  take(pass_over(first, {speed_std, task.signal.rate_hz, {"acceleration"}}), solution);
  return Done{};
}

}  // namespace proofmass::estimate
