#include "proofmass/estimate/track.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/track_carried.hpp"
#include "proofmass/estimate/track_findings.hpp"
#include "proofmass/estimate/track_hypotheses.hpp"
#include "proofmass/estimate/track_motion.hpp"
#include "proofmass/estimate/track_pva.hpp"
#include "proofmass/estimate/track_strokes.hpp"
#include "proofmass/estimate/track_turns.hpp"
#include "proofmass/estimate/track_walk.hpp"

namespace proofmass::estimate {
namespace {

Result<FoundAxis> given_axis(const TrackSignal& signal, std::array<double, 3> direction) {
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (!(length > 0.0)) return Error{Errc::invalid_argument, "the axis has no direction"};
  for (std::size_t a = 0; a < 3; ++a) {
    direction[a] /= length;
    const bool there = std::find(signal.axes.begin(), signal.axes.end(), a) != signal.axes.end();
    if (direction[a] != 0.0 && !there)
      return Error{Errc::invalid_argument, "the axis points where the sensor has none"};
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

// The nearest sample.
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
  for (const PositionFix& fix : options.fixes)
    readings.fixes.push_back(
        {sample_at(signal.time_s, fix.time_s), fix.position_m, fix.std_m * fix.std_m});
  if (options.same_place)
    readings.fixes.push_back(
        {signal.time_s.size() - 1, 0.0, options.same_place_std_m * options.same_place_std_m});
  return readings;
}

// Between the two ends of a gap the position runs as a cubic with their velocities, and may be off
// by what an unknown acceleration does that is 0 at both ends.
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

// Fills what is told of every sample.
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

// Twice integrated from the first sample, less the level of the first rest; a missing reading is
// taken for the one before.
struct DoubleIntegral {
  std::vector<double> position_m, velocity_mps;
};

DoubleIntegral double_integral(View<double> time_s, View<double> accel) {
  DoubleIntegral out;
  std::vector<double>& position = out.position_m;
  position.resize(time_s.size(), 0.0);
  double v = 0.0, last = 0.0;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    const double a = std::isnan(accel[k]) ? last : accel[k];
    if (k > 0) {
      const double h = time_s[k] - time_s[k - 1];
      position[k] = position[k - 1] + h * v + h * h * (last / 3.0 + a / 6.0);
      v += 0.5 * h * (last + a);
    }
    last = a;
    out.velocity_mps.push_back(v);
  }
  return out;
}

// One estimate of position and velocity, one entry a sample.
struct Course {
  View<double> position_m, velocity_mps;
};

// The path is that of the velocity: a filter's position also jumps where it is put right.
TrackMethod method_of(View<double> time_s, const Course& course, View<double> std, double factor) {
  const View<double> position = course.position_m, velocity = course.velocity_mps;
  TrackMethod method;
  std::size_t peak = 0;
  for (std::size_t k = 1; k < position.size(); ++k) {
    method.path_m += 0.5 * std::abs(velocity[k] + velocity[k - 1]) * (time_s[k] - time_s[k - 1]);
    if (std::abs(position[k]) > std::abs(position[peak])) peak = k;
  }
  method.displacement_m = {position.back(), std.back()};
  method.peak_m = {position[peak], std[peak]};
  method.half_width_95_m = factor * std.back();
  return method;
}

// N² t³/3 of the noise, q t⁵/20 of the walk, σ² t⁴/4 of the level that is taken off, over the time
// from the first motion on.
double free_variance(const InertialNoise& noise, double level_variance, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (noise.white_m2ps3 + noise.motion_lean_m2ps3) * t3 / 3.0 +
         (noise.rest_walk_m2ps5 + noise.motion_walk_m2ps5) * t2 * t3 / 20.0 +
         (level_variance + noise.motion_jump_m2ps4) * t2 * t2 / 4.0;
}

// How far double integration drifts: from when the sensor first moves.
double free_std(const TrackSignal& signal, const AxisRun& run) {
  double begin_s = signal.time_s.front(), level_variance = 100.0;
  if (!signal.stops.rests.empty()) {
    const signal::Rest& rest = signal.stops.rests.front();
    const auto blocks =
        static_cast<double>(rest.last - rest.first + 1) / static_cast<double>(run.level.block);
    level_variance = run.level.variance_m2ps4 / std::max(blocks, 1.0);
    if (rest.first == 0) begin_s = signal.time_s[rest.last];
  }
  return std::sqrt(free_variance(run.noise, level_variance, signal.time_s.back() - begin_s));
}

// From the noise at rest alone, before the motion is looked at.
TrackBudget budget_of(const TrackSignal& signal, const AxisRun& quiet) {
  TrackBudget budget;
  budget.white_mps2_rthz = std::sqrt(quiet.noise.white_m2ps3);
  budget.walk_mps2_rts = std::sqrt(quiet.noise.rest_walk_m2ps5);
  budget.free_m = free_std(signal, quiet);
  const AxisPass pass = pass_over(quiet);
  double worst = 0.0;
  for (const Gaussian<3>& x : pass.smoothed) worst = std::max(worst, x.cov(0, 0));
  budget.worst_m = std::sqrt(worst);
  budget.end_m = std::sqrt(std::max(0.0, pass.smoothed.back().cov(0, 0)));
  double left_s = signal.time_s.front();
  const auto motion = [&](double until_s) {
    budget.longest_motion_s = std::max(budget.longest_motion_s, until_s - left_s);
    budget.motion_s += until_s - left_s;
  };
  for (const signal::Rest& rest : signal.stops.rests) {
    motion(signal.time_s[rest.first]);
    left_s = signal.time_s[rest.last];
  }
  motion(signal.time_s.back());
  return budget;
}

std::vector<double> covariance_at(const AxisRun& run, const std::vector<std::size_t>& samples) {
  std::vector<std::size_t> epochs, kept;
  for (const std::size_t sample : samples) epochs.push_back(run.made.of_sample[sample]);
  kept = epochs;
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  const PositionCovariance cov =
      smoothed_positions(InertialAxis{run.made.epochs, run.noise}, run.start, kept);
  const auto place = [&](std::size_t epoch) {
    return static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), epoch) -
                                    kept.begin());
  };
  std::vector<double> entries;
  for (const std::size_t i : epochs)
    for (const std::size_t j : epochs) entries.push_back(cov.at(place(i), place(j)));
  return entries;
}

constexpr double long_rest_s = 1.0;

double length_s(const TrackSignal& signal, const signal::Rest& rest) {
  return signal.time_s[rest.last] - signal.time_s[rest.first];
}

// Where a motion turns round, its acceleration is greatest and for a moment constant, which looks
// like a short rest. Short ones that the motion between the long ones belies are taken out.
std::size_t drop_belied_rests(TrackSignal& signal,
                              View<double> accel,
                              const TrackOptions& options) {
  auto& rests = signal.stops.rests;
  const std::vector<signal::Rest> all = rests;
  const auto is_short = [&](const signal::Rest& rest) {
    return length_s(signal, rest) < long_rest_s;
  };
  std::erase_if(rests, is_short);
  if (rests.size() == all.size() || rests.size() < 2) {
    rests = all;
    return 0;
  }
  const auto knots_of = [&](const AxisRun& run) {
    return join_epochs(run.made.epochs, run.made.knots);
  };
  AxisRun run = prepare_axis(signal, accel, readings_of(signal, options), {});
  const MotionError error = motion_error(knots_of(run), run.noise, run.start);
  rests = all;
  constexpr double unbelievable = 27.6;  // χ² of two degrees of freedom, p = 1e-6
  while (true) {
    run = prepare_axis(signal, accel, readings_of(signal, options), {});
    run.noise.motion_walk_m2ps5 = error.walk_m2ps5;
    run.noise.motion_jump_m2ps4 = error.jump_m2ps4;
    run.noise.motion_lean_m2ps3 = error.lean_m2ps3;
    const std::vector<double> surprise = surprise_of_rests(knots_of(run), run.noise, run.start);
    std::optional<std::size_t> worst;
    for (std::size_t i = 0; i < rests.size(); ++i)
      if (is_short(rests[i]) &&
          surprise[i] > std::max(unbelievable, worst ? surprise[*worst] : 0.0))
        worst = i;
    if (!worst) return all.size() - rests.size();
    rests.erase(rests.begin() + static_cast<std::ptrdiff_t>(*worst));
  }
}

// Everything along one axis, by the rests that the signal has now.
struct AlongAxis {
  FoundAxis axis;
  std::vector<double> accel_mps2;
  AxisRun run;
  MotionError error;
  AxisPass pass;
  std::vector<Closure> closures;
  Consistency consistency;
};

Result<AlongAxis> solve(const TrackSignal& signal, const TrackOptions& options) {
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
  ConsistencyCheck check({.channels = {"position", "velocity at stops", "level at rest"}});
  found.closures = closures(knots, noise, found.run.start, check);
  found.consistency = check.judge();
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

}  // namespace

namespace {

// Everything that is told of the readings before they are integrated.
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

std::vector<signal::Rest> stops_of(const std::vector<signal::Rest>& stops,
                                   const StopHypothesis& hypothesis) {
  std::vector<signal::Rest> rests;
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (hypothesis.stretches[i] == QuietStretch::rest) rests.push_back(stops[i]);
  return rests;
}

// Of what the alternatives say, how probable it is that the displacement is as by the first.
double probability_of_first(const std::vector<TrackAlternative>& alternatives) {
  constexpr double same = 2.0;  // standard deviations
  const Uncertain& first = alternatives.front().displacement_m;
  double sum = 0.0;
  for (const TrackAlternative& one : alternatives)
    if (std::abs(one.displacement_m.value - first.value) <
        same * std::hypot(one.displacement_m.std, first.std))
      sum += one.probability;
  return sum;
}

// What each of several readings of the quiet stretches makes of the displacement.
std::vector<TrackAlternative> alternatives_of(TrackSignal signal,
                                              const std::vector<StopHypothesis>& hypotheses,
                                              const TrackOptions& options) {
  constexpr std::size_t most = 4;
  constexpr double least_probability = 0.02;
  const std::vector<signal::Rest> all = signal.stops.rests;
  std::vector<TrackAlternative> alternatives;
  for (const StopHypothesis& hypothesis : hypotheses) {
    if (hypothesis.probability < least_probability || alternatives.size() == most) break;
    signal.stops.rests = stops_of(all, hypothesis);
    const auto solved = solve(signal, options);
    if (!solved) continue;
    TrackAlternative& alternative = alternatives.emplace_back();
    alternative.probability = hypothesis.probability;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (hypothesis.stretches[i] != QuietStretch::rest)
        alternative.no_rests.push_back({signal.time_s[all[i].first], signal.time_s[all[i].last]});
    const Gaussian<3>& end = solved->pass.smoothed.back();
    alternative.displacement_m = {end.mean(inertial_axis::position_m), std::sqrt(end.cov(0, 0))};
  }
  return alternatives;
}

// Whether the readings look like jerk with the loud ones of the stops left out; then they are.
bool leaves_jerk(TrackSignal& signal, const TrackOptions& options, Result<AlongAxis>& solved) {
  if (options.take_as_acceleration) return false;
  TrackSignal quiet = signal;
  quiet.stops.rests = quiet_rests(signal);
  quiet.stops.cruises = signal.stops.rests.size() - quiet.stops.rests.size();
  auto found = solve(quiet, options);
  if (!found) return false;
  TrackSolution solution = described(quiet, options);
  solution.series.accel_mps2 = found->accel_mps2;
  fill_series(quiet, found->run, found->pass, solution);
  if (!suspect_jerk(quiet, solution.series).suspected) return false;
  signal = std::move(quiet);
  solved = std::move(found);
  return true;
}

// Leaves of the stops what are rests by the likeliest hypothesis, and solves anew. Where that does
// not win clearly: the alternatives.
std::vector<TrackAlternative> settle_stops(TrackSignal& signal,
                                           const TrackOptions& options,
                                           Result<AlongAxis>& solved) {
  constexpr double clear = 0.95;
  std::vector<TrackAlternative> alternatives;
  const auto hypotheses = stop_hypotheses(signal, solved->run, solved->closures);
  if (hypotheses.empty()) {
    signal.stops.too_many_in_doubt = true;
    return alternatives;
  }
  const StopHypothesis& likeliest = hypotheses.front();
  if (hypotheses.size() > 1 && leaves_jerk(signal, options, solved)) return alternatives;
  if (likeliest.probability < clear) {
    alternatives = alternatives_of(signal, hypotheses, options);
    if (alternatives.empty() || probability_of_first(alternatives) >= clear) alternatives.clear();
  }
  const auto count = [&](QuietStretch kind) {
    return static_cast<std::size_t>(std::ranges::count(likeliest.stretches, kind));
  };
  if (count(QuietStretch::rest) == likeliest.stretches.size()) return alternatives;
  signal.stops.cruises = count(QuietStretch::cruise);
  signal.stops.plateaus += count(QuietStretch::plateau);
  signal.stops.rests = stops_of(signal.stops.rests, likeliest);
  solved = solve(signal, options);
  return alternatives;
}

// The methods, from the series.
void judge(const TrackSignal& signal,
           const TrackOptions& options,
           double free_m,
           const PositionCovarianceAt& covariance,
           TrackSolution& solution) {
  TrackSeries& series = solution.series;
  series.resting.assign(signal.time_s.size(), 0);
  for (const signal::Rest& rest : solution.rests)
    for (std::size_t k = rest.first; k <= rest.last; ++k) series.resting[k] = 1;
  DoubleIntegral integral = double_integral(signal.time_s, series.accel_mps2);
  series.double_integral_m = std::move(integral.position_m);
  solution.suspected_jerk = !options.take_as_acceleration && suspect_jerk(signal, series).suspected;
  if (!solution.suspected_jerk && solution.alternatives.empty() && !solution.too_many_in_doubt) {
    const std::vector<double> free(signal.time_s.size(), free_m);
    const double factor = solution.factor_95;
    const View<double> t = series.time_s;
    solution.double_integration =
        method_of(t, {series.double_integral_m, integral.velocity_mps}, free, factor);
    solution.kalman = method_of(t, {series.filtered_position_m, series.filtered_velocity_mps},
                                series.filtered_position_std_m, factor);
    solution.smoother =
        method_of(t, {series.position_m, series.velocity_mps}, series.position_std_m, factor);
    Strokes strokes = find_strokes(solution, covariance);
    solution.strokes = std::move(strokes.strokes);
    solution.smoother->path_std_m = strokes.path_std_m;
  }
  add_findings(signal, options, solution);
}

Result<TrackSolution> track_without_gyro(const TrackSensor& sensor,
                                         TrackSignal signal,
                                         const TrackOptions& options) {
  auto solved = solve(signal, options);
  if (!solved) return solved.error();
  const std::size_t belied = drop_belied_rests(signal, solved->accel_mps2, options);
  if (belied > 0) solved = solve(signal, options);
  std::vector<TrackAlternative> alternatives;
  if (options.still.empty()) alternatives = settle_stops(signal, options, solved);
  AlongAxis found = std::move(solved).value();
  TrackSolution solution = described(signal, options);
  solution.false_rests = belied;
  solution.alternatives = std::move(alternatives);
  solution.axis = found.axis.direction;
  solution.travel_share = found.axis.share;
  solution.scale_std = scale_std(signal, options, solution);
  solution.motion_error = {std::sqrt(found.error.walk_m2ps5), std::sqrt(found.error.jump_m2ps4),
                           std::sqrt(found.error.lean_m2ps3)};
  solution.factor_95 = found.error.factor_95;
  solution.closures = std::move(found.closures);
  solution.consistency = found.consistency;
  solution.series.accel_mps2 = std::move(found.accel_mps2);
  fill_series(signal, found.run, found.pass, solution);
  const PvaTask task{sensor, signal, found.run, readings_of(signal, options)};
  if (const auto done = apply_track_model(task, options, solution); !done) return done.error();
  AxisRun quiet = found.run;
  quiet.noise.motion_walk_m2ps5 = quiet.noise.rest_walk_m2ps5;
  quiet.noise.motion_jump_m2ps4 = quiet.noise.motion_lean_m2ps3 = 0.0;
  solution.budget = budget_of(signal, quiet);
  judge(
      signal, options, free_std(signal, found.run),
      [&](const std::vector<std::size_t>& samples) { return covariance_at(found.run, samples); },
      solution);
  return solution;
}

// A bound: the velocity is off by its standard deviation all the way from one turn to the next.
std::vector<double> covariance_by_velocity(const TrackSeries& series,
                                           const std::vector<std::size_t>& samples) {
  const std::size_t n = samples.size();
  std::vector<double> sum(n, 0.0), entries(n * n);
  for (std::size_t i = 1; i < n; ++i) {
    sum[i] = sum[i - 1];
    for (std::size_t k = samples[i - 1] + 1; k <= samples[i]; ++k)
      sum[i] += series.velocity_std_mps[k] * (series.time_s[k] - series.time_s[k - 1]);
  }
  const auto variance = [&](std::size_t i) {
    return series.position_std_m[samples[i]] * series.position_std_m[samples[i]];
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      entries[i * n + j] =
          0.5 * (variance(i) + variance(j) - (sum[i] - sum[j]) * (sum[i] - sum[j]));
  return entries;
}

Result<TrackSolution> track_with_gyro(const TrackSensor& sensor,
                                      const TrackSignal& signal,
                                      const TrackOptions& options) {
  TrackSolution solution = described(signal, options);
  const TrackReadings readings = readings_of(signal, options);
  if (const auto done = track_carried(sensor, signal, readings, options, solution); !done)
    return done.error();
  const AxisRun quiet = prepare_axis(signal, solution.series.accel_mps2, readings, {});
  solution.budget = budget_of(signal, quiet);
  judge(
      signal, options, free_std(signal, quiet),
      [&](const std::vector<std::size_t>& samples) {
        return covariance_by_velocity(solution.series, samples);
      },
      solution);
  return solution;
}

// Where all of the recording is as quiet as rest, a slow motion may hide in its noise: then only
// the two ends are taken for rests, and the interval is that of a motion between them.
void keep_ends_of_rest(TrackSignal& signal) {
  constexpr double nearly_all = 0.95, longest_end_s = 2.0;
  const double all_s = signal.time_s.back() - signal.time_s.front();
  double resting_s = 0.0;
  for (const signal::Rest& rest : signal.stops.rests) resting_s += length_s(signal, rest);
  if (resting_s < nearly_all * all_s) return;
  const double end_s = std::min(longest_end_s, 0.25 * all_s);
  const std::size_t n = signal.time_s.size();
  const std::size_t first = sample_at(signal.time_s, signal.time_s.front() + end_s),
                    last = sample_at(signal.time_s, signal.time_s.back() - end_s);
  if (first == 0 || last + 1 >= n || first >= last) return;
  signal.stops.rests = {{0, first}, {last, n - 1}};
  signal.stops.only_ends = true;
}

bool has_gyro(const TrackSensor& sensor) {
  return std::none_of(sensor.rate_radps.begin(), sensor.rate_radps.end(),
                      [](const auto& axis) { return axis.empty(); });
}

}  // namespace

Result<TrackSolution> estimate_track(const TrackSensor& sensor, const TrackOptions& options) {
  auto made = track_signal(sensor, options);
  if (!made) return made.error();
  TrackSignal signal = std::move(made).value();
  if (signal.stops.rests.empty() && options.fixes.empty()) return no_stop(signal);
  if (options.still.empty() && may_hide_motion(signal)) return hidden_motion();
  if (options.still.empty()) {
    drop_plateaus(signal);
    keep_ends_of_rest(signal);
  }
  const bool inertial = options.model == TrackModel::inertial;
  if (inertial && has_gyro(sensor) && signal.gravity == GravityContent::present)
    return track_with_gyro(sensor, signal, options);
  return track_without_gyro(sensor, std::move(signal), options);
}

}  // namespace proofmass::estimate
