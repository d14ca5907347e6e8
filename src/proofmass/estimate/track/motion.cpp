#include "proofmass/estimate/track/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

constexpr double speed_at_start_mps = 10.0;
constexpr double gap_steps = 2.5;          // a longer step between samples is a gap
constexpr double carried_mps2_rts = 3e-3;  // random walk used in the search for the axis

}  // namespace

std::optional<double> density_along(const std::array<std::optional<double>, 3>& figures,
                                    const std::array<double, 3>& axis) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (axis[a] == 0.0) continue;
    if (!figures[a]) return std::nullopt;
    sum += axis[a] * axis[a] * *figures[a] * *figures[a];
  }
  return std::sqrt(sum);
}

namespace {

// White noise of one measurement, from third differences, which suppress smooth motion; robust
// against outliers in half of them. 0 if there are few.
double sample_std(View<double> accel, const std::vector<unsigned char>& wanted) {
  constexpr std::size_t few = 50;
  std::vector<double> differences;
  for (std::size_t k = 3; k < accel.size(); ++k)
    if (wanted[k] && wanted[k - 1] && wanted[k - 2] && wanted[k - 3])
      differences.push_back(accel[k] - 3.0 * (accel[k - 1] - accel[k - 2]) - accel[k - 3]);
  if (differences.size() < few) return 0.0;
  return robust_std(differences).value_or(0.0) / std::sqrt(20.0);
}

// Two-sided density of the vibration in motion, if it is white.
double shaking_density(View<double> accel, const std::vector<signal::Rest>& rests, double rate_hz) {
  constexpr double clear = 1.1;  // beyond the statistical scatter of the two
  std::vector<unsigned char> resting(accel.size(), 0), moving(accel.size(), 1);
  for (const signal::Rest& rest : rests)
    for (std::size_t k = rest.first; k <= rest.last; ++k) resting[k] = 1, moving[k] = 0;
  const double at_rest = sample_std(accel, resting), in_motion = sample_std(accel, moving);
  if (!(at_rest > 0.0) || in_motion < clear * at_rest) return 0.0;
  return (in_motion * in_motion - at_rest * at_rest) / rate_hz;
}

}  // namespace

AxisRun prepare_axis(const TrackSignal& signal,
                     View<double> accel,
                     const TrackReadings& readings,
                     const AxisNoise& known) {
  AxisRun run;
  run.level = level_noise(accel, readings.rests, signal.rate_hz);
  if (readings.rests.empty()) {
    const std::vector<unsigned char> all(accel.size(), 1);
    run.level.sample_std_mps2 = sample_std(accel, all);
    run.level.variance_m2ps4 =
        std::max(run.level.variance_m2ps4,
                 square(run.level.sample_std_mps2) / static_cast<double>(run.level.block));
  }
  const AxisSignal axis{signal.time_s, accel, std::max(moments(accel).std(), 1e-6),
                        gap_steps / signal.rate_hz};
  run.made = axis_epochs(axis, readings, run.level);
  const double white = known.white_mps2_rthz.value_or(0.0);
  const double walk = known.walk_mps2_rts.value_or(0.0);
  run.noise = {.white_m2ps3 = std::max(white * white, run.level.white_m2ps3()),
               .shaking_m2ps3 = shaking_density(accel, readings.rests, signal.rate_hz),
               .rest_walk_m2ps5 = std::max(walk * walk, run.level.walk_m2ps5),
               .rest_speed_std_mps = readings.rest_speed_std_mps};
  run.start.speed_std_mps = speed_at_start_mps;
  run.smoother_start = run.start;
  run.longest_step_s = axis.longest_step_s;
  return run;
}

AxisPass pass_over(const AxisRun& run) {
  AxisPass pass;
  const InertialAxis model{run.made.epochs, run.noise};
  pass.filtered.resize(model.size());
  pass.smoothed.resize(model.size());
  const auto keep_filtered = [&](std::size_t k, const StepOf<InertialAxis>& step) {
    pass.filtered[k] = step.filtered;
  };
  const bool is_narrower = run.smoother_start.bias_std_mps2 < run.start.bias_std_mps2 ||
                           run.smoother_start.speed_std_mps < run.start.speed_std_mps;
  if (is_narrower) {
    FilterState<3> state = inertial_start(run.start);
    filter(model, {0, model.size()}, Gate{}, state, keep_filtered);
  }
  smooth(
      model, inertial_start(run.smoother_start), Gate{},
      [&](std::size_t k, const StepOf<InertialAxis>& step) {
        if (!is_narrower) keep_filtered(k, step);
      },
      [&](std::size_t k, const StepOf<InertialAxis>& step, const BackwardInformation<3>& later) {
        pass.smoothed[k] = {later.mean(step.filtered), later.template cov<3>(step.filtered)};
      });
  return pass;
}

namespace {

struct StartStd {
  double speed_mps, bias_mps2;
};

// The prior about the state that it leads to, within 30 of its standard deviations or `least`.
// nullopt if that state is not within the prior.
std::optional<InertialStart> narrower(AxisRun run, const StartStd& least) {
  constexpr double wider = 30.0, far = 3.0;
  constexpr int v = inertial_axis::velocity_mps, b = inertial_axis::bias_mps2;
  run.start = run.smoother_start;
  const Gaussian<3> found = pass_over(run).smoothed.front();
  const InertialStart& prior = run.start;
  if (std::abs(found.mean(v) - prior.speed_mps) > far * prior.speed_std_mps ||
      std::abs(found.mean(b) - prior.bias_mps2) > far * prior.bias_std_mps2)
    return std::nullopt;
  const auto within = [&](int state, double least_std, double prior_std) {
    const double std = std::sqrt(std::max(0.0, found.cov(state, state)));
    return std::min(prior_std, std::max(least_std, wider * std));
  };
  return InertialStart{.speed_mps = found.mean(v),
                       .speed_std_mps = within(v, least.speed_mps, prior.speed_std_mps),
                       .bias_mps2 = found.mean(b),
                       .bias_std_mps2 = within(b, least.bias_mps2, prior.bias_std_mps2)};
}

}  // namespace

InertialStart narrowed_start(const AxisRun& run) {
  // In two steps, since the first one has lost the digits of what it finds.
  constexpr std::array<StartStd, 2> steps{{{0.1, 0.02}, {3e-3, 3e-4}}};
  if (run.made.epochs.size() < 2 || run.made.epochs[1].resting) return run.start;
  AxisRun trial = run;
  for (const StartStd& least : steps) {
    const auto narrow = narrower(trial, least);
    if (!narrow) return run.start;
    trial.smoother_start = *narrow;
  }
  return narrower(trial, steps.back()) ? trial.smoother_start : run.start;
}

FoundAxis farthest_axis(const std::vector<std::vector<double>>& velocity,
                        View<double> time_s,
                        const std::vector<std::size_t>& axes) {
  FoundAxis found;
  const auto n = static_cast<int>(axes.size());
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(n, n);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b <= a; ++b) {
      const auto &x = velocity[static_cast<std::size_t>(a)],
                 &y = velocity[static_cast<std::size_t>(b)];
      double sum = 0.0;
      for (std::size_t k = 1; k < time_s.size(); ++k)
        sum += x[k] * y[k] * (time_s[k] - time_s[k - 1]);
      scatter(a, b) = scatter(b, a) = sum;
    }
  const SymmetricEigen eigen = symmetric_eigen(scatter);
  const double total = eigen.values.sum();
  if (total > 0.0) found.share = std::min(eigen.values(n - 1) / total, 1.0);
  for (int a = 0; a < n; ++a)
    found.direction[axes[static_cast<std::size_t>(a)]] = eigen.vectors(a, n - 1);
  const double largest =
      *std::max_element(found.direction.begin(), found.direction.end(),
                        [](double x, double y) { return std::abs(x) < std::abs(y); });
  if (largest < 0.0)
    for (double& x : found.direction) x = -x;
  return found;
}

FoundAxis farthest_axis(const TrackSignal& signal, const TrackReadings& readings) {
  TrackReadings own = readings;
  own.fixes.clear();  // they refer to an axis that is not known yet
  std::vector<std::vector<double>> velocity;
  for (const std::vector<double>& accel : signal.accel_mps2) {
    AxisRun run = prepare_axis(signal, accel, own, {});
    run.noise.motion_walk_m2ps5 = carried_mps2_rts * carried_mps2_rts;
    const AxisPass pass = pass_over(run);
    auto& of_axis = velocity.emplace_back();
    for (const std::size_t epoch : run.made.of_sample)
      of_axis.push_back(pass.smoothed[epoch].mean(inertial_axis::velocity_mps));
  }
  return farthest_axis(velocity, signal.time_s, signal.axes);
}

}  // namespace proofmass::estimate
