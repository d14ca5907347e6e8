#include "proofmass/thesis/wheel/fourteen_state_filter.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "proofmass/estimate/models/fusion_model.hpp"

namespace proofmass::thesis {
namespace {

namespace fusion = estimate::fusion;
using Run = estimate::LinearRun<14, 4>;
using Series = estimate::LinearSeries<14, 4, 2>;

/// What the pair of one axis has in common, x or y.
struct Shared {
  KnownBias bias;  ///< of the fused signal
  double start_speed_mps = 0.0, start_speed_std_mps = 0.0;
};

std::array<Shared, 2> shared_by(const FirstTurn& turn) {
  std::array<Shared, 2> shared;
  for (const WheelAxis axis : {WheelAxis::outward, WheelAxis::forward}) {
    const FusedReading fused = *fuse(turn, axis, Fusion::gravity_cancelled);
    shared[static_cast<std::size_t>(axis)] = {
        .bias = {fused.bias_mps2, fused.bias_rise_mps2, fused.time_constant_s},
        .start_speed_mps = fused.start_speed_mps.value,
        .start_speed_std_mps = fused.start_speed_mps.std};
  }
  return shared;
}

Result<Series> series_of(const FirstTurn& turn, const std::array<Shared, 2>& shared) {
  std::vector<estimate::Epoch<4, 2>> epochs(turn.size());
  for (std::size_t k = 0; k < turn.size(); ++k) {
    // To the nanosecond: even time then has one model.
    if (k > 0) epochs[k].dt_s = std::round((turn.time_s[k] - turn.time_s[k - 1]) * 1e9) * 1e-9;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto at = static_cast<int>(axis);
      epochs[k].z(at) = turn.force_mps2[0][axis][k];
      epochs[k].z(2 + at) = -turn.force_mps2[1][axis][k];
      epochs[k].u(at) = shared[axis].bias.start_mps2.value + shared[axis].bias.rise_mps2;
    }
  }
  return Series::make(std::move(epochs), [&](double dt_s) {
    estimate::FusionModelOptions options;
    options.axes.fill({.dt_s = dt_s,
                       .jerk_psd_m2ps5 = 1.0,
                       .accel_variance_m2ps4 = turn.noise_mps2 * turn.noise_mps2});
    options.bias_x = {
        .dt_s = dt_s, .time_constant_s = shared[0].bias.time_constant_s, .bias_psd_m2ps5 = 0.0};
    options.bias_y = {
        .dt_s = dt_s, .time_constant_s = shared[1].bias.time_constant_s, .bias_psd_m2ps5 = 0.0};
    return estimate::fusion_model(options);
  });
}

estimate::Gaussian<14> start_of(const std::array<Shared, 2>& shared) {
  estimate::Gaussian<14> start;
  for (int axis = 0; axis < fusion::axes; ++axis) {
    const Shared& of = shared[static_cast<std::size_t>(axis % 2)];
    const int at = 3 * axis;
    start.mean(at + 1) = of.start_speed_mps;
    start.cov(at, at) = 1e-12;
    start.cov(at + 1, at + 1) = std::pow(of.start_speed_std_mps, 2);
    start.cov(at + 2, at + 2) = 100.0;  // P0
  }
  for (int axis = 0; axis < 2; ++axis) {
    const Uncertain& bias = shared[static_cast<std::size_t>(axis)].bias.start_mps2;
    start.mean(fusion::bias_x_mps2 + axis) = bias.value;
    start.cov(fusion::bias_x_mps2 + axis, fusion::bias_x_mps2 + axis) = bias.std * bias.std;
  }
  return start;
}

/// Error of the mean of the positions, of y1 and y2 or of all four.
PathError error_of(const FirstTurn& turn, const Run& run, bool smoothed, bool all) {
  std::vector<double> path;
  for (const auto& step : run.steps) {
    const auto& x = (smoothed ? step.smoothed : step.filtered).mean;
    const double roll = 0.5 * (x(3) + x(9)), pitch = 0.5 * (x(0) + x(6));
    path.push_back(all ? 0.5 * (roll + pitch) : roll);
  }
  return path_error(turn, path, turn.path_m(turn.angle_rad), 0.0);
}

}  // namespace

Result<std::optional<FourteenStateFilter>> fourteen_state_filter(const FirstTurn& turn) {
  if (!turn.radius_m || !fuse(turn, WheelAxis::forward, Fusion::gravity_cancelled))
    return std::optional<FourteenStateFilter>{};
  const std::array<Shared, 2> shared = shared_by(turn);
  Result<Series> series = series_of(turn, shared);
  if (!series) return Error(series.error()).at(turn.source);
  const Run run = estimate::smooth_linear(std::move(series).value(), start_of(shared),
                                          {.smoother = estimate::Smoother::rauch_tung_striebel});
  return std::optional<FourteenStateFilter>({.roll_filtered = error_of(turn, run, false, false),
                                             .roll_smoothed = error_of(turn, run, true, false),
                                             .all_filtered = error_of(turn, run, false, true),
                                             .all_smoothed = error_of(turn, run, true, true)});
}

}  // namespace proofmass::thesis
