#include "proofmass/estimate/track.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/track/aided.hpp"
#include "proofmass/estimate/track/findings.hpp"
#include "proofmass/estimate/track/fixes.hpp"
#include "proofmass/estimate/track/hypotheses.hpp"
#include "proofmass/estimate/track/pva.hpp"
#include "proofmass/estimate/track/settle.hpp"
#include "proofmass/estimate/track/strokes.hpp"
#include "proofmass/estimate/track/turns.hpp"

namespace proofmass::estimate {
namespace {

// Double integral from the first sample, minus the level of the first rest; a missing measurement
// repeats the previous one.
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

// The path length uses the velocity: a filter's position also jumps at corrections.
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

// N² t³/3 from the noise, q t⁵/20 from the random walk, σ² t⁴/4 from the subtracted level, over the
// time from the first motion on.
double free_variance(const InertialNoise& noise, double level_variance, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (noise.white_m2ps3 + noise.motion_lean_m2ps3) * t3 / 3.0 +
         (noise.rest_walk_m2ps5 + noise.motion_walk_m2ps5) * t2 * t3 / 20.0 +
         (level_variance + noise.motion_jump_m2ps4) * t2 * t2 / 4.0;
}

// Uncertainty of double integration, from the first motion on.
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

// From the noise at rest alone, independent of the motion.
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
      smoothed_positions(InertialAxis{run.made.epochs, run.noise}, run.smoother_start, kept);
  const auto place = [&](std::size_t epoch) {
    return static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), epoch) -
                                    kept.begin());
  };
  std::vector<double> entries;
  for (const std::size_t i : epochs)
    for (const std::size_t j : epochs) entries.push_back(cov.at(place(i), place(j)));
  return entries;
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

// The user has not stated the static intervals.
bool rests_are_in_doubt(const TrackOptions& options) {
  return options.still.empty() && !options.only_end_rests;
}

struct Settled {
  AlongAxis along;
  std::size_t belied = 0;  // short quiet intervals that are no rests
  FixReview fixes;
  std::vector<TrackAlternative> alternatives;
};

// Decides which quiet intervals are rests, removes the others from the signal, and corrects the
// fixes.
Result<Settled> settle(TrackSignal& signal, TrackOptions& options) {
  auto solved = solve(signal, options);
  if (!solved) return solved.error();
  Settled settled;
  if (!options.only_end_rests)
    settled.belied = drop_belied_rests(signal, solved->accel_mps2, options);
  if (settled.belied > 0) solved = solve(signal, options);
  if (!solved) return solved.error();
  AlongAxis found = std::move(solved).value();
  settled.fixes = review_fixes(signal, options, rests_are_in_doubt(options), found);
  solved = std::move(found);
  if (rests_are_in_doubt(options)) settled.alternatives = settle_stops(signal, options, solved);
  settled.along = std::move(solved).value();
  return settled;
}

void add_alternatives(std::vector<TrackAlternative> alternatives, TrackSolution& solution) {
  solution.alternatives = std::move(alternatives);
  for (TrackAlternative& one : solution.alternatives) {
    Uncertain& displacement = one.displacement_m;
    displacement.std = std::hypot(displacement.std, solution.scale_std * displacement.value);
  }
}

Result<TrackSolution> track_without_gyro(const TrackSensor& sensor,
                                         TrackSignal signal,
                                         TrackOptions options) {
  auto result = settle(signal, options);
  if (!result) return result.error();
  auto settled = std::move(result).value();
  AlongAxis& found = settled.along;
  TrackSolution solution = described(signal, options);
  solution.false_rests = settled.belied;
  solution.fix_review = std::move(settled.fixes);
  solution.axis = found.axis.direction;
  solution.travel_share = found.axis.share;
  solution.scale_std = scale_std(signal, options, solution);
  add_alternatives(std::move(settled.alternatives), solution);
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

// An upper bound: the velocity is off by its standard deviation from one turning point to the next.
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

// As settle(), in world axes: the gyroscope's attitude removes gravity, so that a change of level
// is acceleration, not tilt.
Result<Settled> settle_with_gyro(const TrackSensor& sensor,
                                 TrackSignal& signal,
                                 TrackOptions& options) {
  auto made = world_signal(sensor, signal, options);
  if (!made) return made.error();
  TrackSignal world = std::move(made).value();
  TrackOptions level = options;
  level.take_as_acceleration = true;
  auto settled = settle(world, level);
  signal.stops = world.stops;
  options.fixes = std::move(level.fixes);
  return settled;
}

Result<TrackSolution> track_with_gyro(const TrackSensor& sensor,
                                      TrackSignal signal,
                                      TrackOptions options) {
  Settled settled;
  const bool has_fixes = !options.fixes.empty() && !signal.stops.rests.empty();
  if (has_fixes || (rests_are_in_doubt(options) && signal.stops.rests.size() > 2)) {
    auto found = settle_with_gyro(sensor, signal, options);
    if (!found) return found.error();
    settled = std::move(found).value();
  }
  TrackSolution solution = described(signal, options);
  solution.false_rests = settled.belied;
  solution.fix_review = std::move(settled.fixes);
  const TrackReadings readings = readings_of(signal, options);
  if (const auto done = track_aided(sensor, signal, readings, options, solution); !done)
    return done.error();
  add_alternatives(std::move(settled.alternatives), solution);
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

bool has_gyro(const TrackSensor& sensor) {
  return std::none_of(sensor.rate_radps.begin(), sensor.rate_radps.end(),
                      [](const auto& axis) { return axis.empty(); });
}

}  // namespace

Result<TrackSolution> estimate_track(const TrackSensor& sensor, const TrackOptions& options) {
  auto made = track_signal(sensor, options);
  if (!made) return made.error();
  TrackSignal signal = std::move(made).value();
  if (options.fixes.empty())
    if (const auto gap = unbridgeable_gap(signal)) return *gap;
  if (signal.stops.rests.empty() && options.fixes.empty()) return no_stop(signal);
  if (rests_are_in_doubt(options)) {
    if (may_hide_motion(signal)) return hidden_motion();
    drop_plateaus(signal);
    keep_ends_of_rest(signal);
  }
  const bool inertial = options.model == TrackModel::inertial;
  if (inertial && has_gyro(sensor) && signal.gravity == GravityContent::present)
    return track_with_gyro(sensor, std::move(signal), options);
  return track_without_gyro(sensor, std::move(signal), options);
}

}  // namespace proofmass::estimate
