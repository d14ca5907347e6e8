#include "proofmass/estimate/track/pva.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proofmass/estimate/track/axis_inputs.hpp"
#include "proofmass/estimate/track/jerk.hpp"
#include "proofmass/estimate/track/motion_noise.hpp"
#include "proofmass/estimate/track/pva_pass.hpp"

namespace proofmass::estimate {
namespace {

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
                   const std::vector<const AxisInput*>& sensors,
                   const std::vector<PvaSample>& samples,
                   double jerk_psd) {
  std::vector<PvaSensor> readings;
  for (const AxisInput* sensor : sensors) readings.push_back(sensor->reading(task.signal.rate_hz));
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

FusedSensor fused_sensor(const AxisInput& sensor,
                         const PvaPass& alone,
                         const Uncertain& bias,
                         double scale_std) {
  const double end_m = alone.smoothed.position_m.back();
  return {sensor.name,
          {sensor.level_mps2 + bias.value, bias.std},
          {end_m, std::hypot(alone.smoothed.position_std_m.back(), scale_std * end_m)}};
}

// Common error of all sensors in motion, from the closure errors of their mean.
struct CommonError {
  double share_std = 1.0;  // √Σw²: of errors that each sensor has for itself, one in the mean
  PvaNoise noise;
  MotionError figures;
};

CommonError common_error(const PvaTask& task,
                         const std::vector<AxisInput>& sensors,
                         double jerk_psd) {
  CommonError found;
  double sum = 0.0, squares = 0.0;
  for (const AxisInput& one : sensors) {
    sum += 1.0 / one.white_m2ps3;
    squares += 1.0 / (one.white_m2ps3 * one.white_m2ps3);
  }
  found.share_std = std::sqrt(squares) / sum;
  std::vector<double> mean(task.signal.time_s.size(), 0.0);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    double weights = 0.0;
    for (const AxisInput& one : sensors) {
      if (std::isnan(one.accel_mps2[k])) continue;
      mean[k] += one.accel_mps2[k] / one.white_m2ps3;
      weights += 1.0 / one.white_m2ps3;
    }
    mean[k] /= weights;  // NaN without any measurement
  }
  AxisRun run = prepare_axis(task.signal, mean, task.readings, {});
  found.figures = motion_error(join_epochs(run.made.epochs, run.made.knots), run.noise, run.start);
  run.noise.motion_walk_m2ps5 = found.figures.walk_m2ps5;
  run.noise.motion_jump_m2ps4 = found.figures.jump_m2ps4;
  run.noise.motion_lean_m2ps3 = found.figures.lean_m2ps3;
  found.noise = noise_of({task.sensor, task.signal, run, task.readings}, jerk_psd);
  return found;
}

void fuse(const PvaTask& task,
          const AxisInputs& sensors,
          double jerk_psd,
          TrackSolution& solution) {
  std::vector<const AxisInput*> all;
  std::vector<std::string> names;
  for (const AxisInput& one : sensors.all) {
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
  solution.scale_std *= common.share_std;  // the sensors' scale errors are independent
  take(std::move(fused), solution);
  solution.factor_95 = common.figures.factor_95;
  solution.motion_error = {std::sqrt(common.figures.walk_m2ps5),
                           std::sqrt(common.figures.jump_m2ps4),
                           std::sqrt(common.figures.lean_m2ps3)};
  const double std = solution.series.position_std_m.back();
  if (std > 0.0) track.variance_gain = best * best / (std * std);
  solution.fused = std::move(track);
}
}  // namespace

Status apply_track_model(const PvaTask& task,
                         const TrackOptions& options,
                         TrackSolution& solution) {
  if (options.model == TrackModel::inertial) return Done{};
  if (options.jerk_psd_m2ps5 && !(*options.jerk_psd_m2ps5 > 0.0))
    return Error{Errc::invalid_argument, "the density of the jerk must be positive"};
  auto made = axis_inputs(task, options, solution);
  if (!made) return made.error();
  const AxisInputs sensors = std::move(made).value();
  PvaAxis<1> first = axis_of<1>(task, {&sensors.all.front()}, sensors.samples, 1.0);
  const double speed_std = task.run.start.speed_std_mps;
  const JerkDensity jerk = options.jerk_psd_m2ps5 ? JerkDensity{*options.jerk_psd_m2ps5, 0.0, true}
                                                  : likeliest_jerk(first, speed_std);
  solution.model = options.model;
  if (jerk.determined) solution.jerk_psd_m2ps5 = Uncertain{jerk.psd_m2ps5, jerk.std_m2ps5};
  if (options.model == TrackModel::fused) {
    fuse(task, sensors, jerk.psd_m2ps5, solution);
    return Done{};
  }
  first.noise.jerk_psd_m2ps5 = jerk.psd_m2ps5;
  take(pass_over(first, {speed_std, task.signal.rate_hz, {"acceleration"}}), solution);
  return Done{};
}

}  // namespace proofmass::estimate
