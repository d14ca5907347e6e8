#include "proofmass/estimate/track/solve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::estimate {
namespace {

Result<FoundAxis> given_axis(const TrackSignal& signal, std::array<double, 3> direction) {
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (!(length > 0.0)) return Error{Errc::invalid_argument, "the axis has no direction"};
  for (std::size_t a = 0; a < 3; ++a) {
    direction[a] /= length;
    const bool there = std::find(signal.axes.begin(), signal.axes.end(), a) != signal.axes.end();
    if (direction[a] != 0.0 && !there)
      return Error{Errc::invalid_argument, "the sensor has no axis in this direction"};
  }
  return FoundAxis{direction, 1.0};
}

std::vector<double> along(const TrackSignal& signal, const std::array<double, 3>& axis) {
  std::vector<double> out(signal.time_s.size(), 0.0);
  for (std::size_t a = 0; a < signal.axes.size(); ++a)
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] += axis[signal.axes[a]] * signal.accel_mps2[a][k];
  return out;
}

// Between the two ends of a gap the position is a cubic with their velocities, with the uncertainty
// of an unknown acceleration that is 0 at both ends.
void bridge(const AxisEpochs::Gap& gap, TrackSeries& series) {
  const std::size_t a = gap.first > 0 ? gap.first - 1 : gap.first, b = gap.last + 1;
  const double h = series.time_s[b] - series.time_s[a];
  const auto cubic = [&](std::vector<double>& p, View<double> v, std::size_t k) {
    const double s = (series.time_s[k] - series.time_s[a]) / h, r = 1.0 - s;
    p[k] = r * r * (1.0 + 2.0 * s) * p[a] + s * s * (3.0 - 2.0 * s) * p[b] +
           s * r * h * (r * v[a] - s * v[b]);
    return gap.unknown_accel_std_mps2 * h * h * s * r / 2.0;
  };
  for (std::size_t k = gap.first; k <= gap.last; ++k) {
    const double off = cubic(series.position_m, series.velocity_mps, k);
    cubic(series.filtered_position_m, series.filtered_velocity_mps, k);
    for (auto* std : {&series.position_std_m, &series.filtered_position_std_m})
      (*std)[k] = std::hypot(std::max((*std)[a], (*std)[b]), off);
    const double s = (series.time_s[k] - series.time_s[a]) / h;
    series.velocity_mps[k] = (1.0 - s) * series.velocity_mps[a] + s * series.velocity_mps[b];
    series.velocity_std_mps[k] =
        std::hypot(std::max(series.velocity_std_mps[a], series.velocity_std_mps[b]),
                   gap.unknown_accel_std_mps2 * h / 2.0);
  }
}

}  // namespace

std::size_t sample_at(View<double> time_s, double t) {
  const auto after =
      static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t) - time_s.begin());
  if (after == time_s.size()) return after - 1;
  return after > 0 && t - time_s[after - 1] < time_s[after] - t ? after - 1 : after;
}

TrackReadings readings_of(const TrackSignal& signal, const TrackOptions& options) {
  TrackReadings readings;
  readings.rests = signal.stops.rests;
  readings.rest_speed_std_mps = options.rest_speed_std_mps;
  for (const double t : options.turns_s) readings.turns.push_back(sample_at(signal.time_s, t));
  for (const PositionFix& fix : options.fixes) {
    const std::size_t sample = sample_at(signal.time_s, fix.time_s);
    readings.fixes.push_back(
        {sample, fix.position_m, fix.std_m * fix.std_m, fix.time_s - signal.time_s[sample]});
  }
  if (options.same_place)
    readings.fixes.push_back(
        {signal.time_s.size() - 1, 0.0, options.same_place_std_m * options.same_place_std_m});
  return readings;
}

void fill_series(const TrackSignal& signal,
                 const AxisRun& run,
                 const AxisPass& pass,
                 TrackSolution& solution) {
  TrackSeries& series = solution.series;
  const auto std_of = [&](const Gaussian<3>& x, int i) {
    return std::hypot(std::sqrt(std::max(0.0, x.cov(i, i))), solution.scale_std * x.mean(i));
  };
  for (std::size_t k = 0; k < signal.time_s.size(); ++k) {
    const Gaussian<3>& s = pass.smoothed[run.made.of_sample[k]];
    const Gaussian<3>& f = pass.filtered[run.made.of_sample[k]];
    series.position_m.push_back(s.mean(inertial_axis::position_m));
    series.position_std_m.push_back(std_of(s, inertial_axis::position_m));
    series.velocity_mps.push_back(s.mean(inertial_axis::velocity_mps));
    series.velocity_std_mps.push_back(std_of(s, inertial_axis::velocity_mps));
    series.filtered_position_m.push_back(f.mean(inertial_axis::position_m));
    series.filtered_position_std_m.push_back(std_of(f, inertial_axis::position_m));
    series.filtered_velocity_mps.push_back(f.mean(inertial_axis::velocity_mps));
  }
  for (const AxisEpochs::Gap& gap : run.made.gaps) bridge(gap, series);
}

Result<AlongAxis> solve_errors(const TrackSignal& signal, const TrackOptions& options) {
  AlongAxis found;
  const TrackReadings readings = readings_of(signal, options);
  auto axis = options.axis ? given_axis(signal, *options.axis)
                           : Result<FoundAxis>(farthest_axis(signal, readings));
  if (!axis) return axis.error();
  found.axis = *axis;
  found.accel_mps2 = along(signal, found.axis.direction);
  found.run = prepare_axis(signal, found.accel_mps2, readings,
                           {density_along(options.white_mps2_rthz, found.axis.direction),
                            density_along(options.walk_mps2_rts, found.axis.direction)});
  const auto knots = join_epochs(found.run.made.epochs, found.run.made.knots);
  InertialNoise& noise = found.run.noise;
  found.error = motion_error(knots, noise, found.run.start);
  noise.motion_walk_m2ps5 = found.error.walk_m2ps5;
  noise.motion_jump_m2ps4 = found.error.jump_m2ps4;
  noise.motion_lean_m2ps3 = found.error.lean_m2ps3;
  return found;
}

Result<AlongAxis> solve(const TrackSignal& signal, const TrackOptions& options) {
  auto errors = solve_errors(signal, options);
  if (!errors) return errors.error();
  AlongAxis found = std::move(errors).value();
  const auto knots = join_epochs(found.run.made.epochs, found.run.made.knots);
  ConsistencyCheck check({.channels = {"position", "velocity at stops", "level at rest"}});
  found.closures = closures(knots, found.run.noise, found.run.start, check);
  found.consistency = check.judge();
  found.run.smoother_start = narrowed_start(found.run);
  found.pass = pass_over(found.run);
  for (Closure& closure : found.closures) {
    const std::size_t first = sample_at(signal.time_s, signal.time_s.front() + closure.start_s);
    const std::size_t last = sample_at(signal.time_s, signal.time_s.front() + closure.end_s);
    for (std::size_t k = first; k < last; ++k)
      closure.fastest_mps = std::max(closure.fastest_mps,
                                     std::abs(found.pass.filtered[found.run.made.of_sample[k]].mean(
                                         inertial_axis::velocity_mps)));
  }
  return found;
}

TrackSolution described(const TrackSignal& signal, const TrackOptions& options) {
  TrackSolution solution;
  solution.axis_given = options.axis.has_value();
  solution.gravity = signal.gravity;
  solution.resting_norm_mps2 = signal.resting_norm_mps2;
  solution.turned_rad = largest_turn_rad(signal);
  solution.missing = signal.missing;
  solution.rests = signal.stops.rests;
  solution.rests_by_quietness = signal.stops.by_quietness;
  solution.cruises = signal.stops.cruises;
  solution.plateaus = signal.stops.plateaus;
  solution.no_motion_shown = signal.stops.only_ends;
  solution.too_many_in_doubt = signal.stops.too_many_in_doubt;
  solution.series.time_s = signal.time_s;
  return solution;
}

}  // namespace proofmass::estimate
