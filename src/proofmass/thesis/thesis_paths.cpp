#include "proofmass/thesis/thesis_paths.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::thesis {
namespace {

namespace pva = estimate::pva;

constexpr double jerk_psd_m2ps5 = 1.0;       // W
constexpr double start_accel_m2ps4 = 100.0;  // P0
constexpr double start_position_m2 = 1e-12;  // known

using Run = estimate::LinearRun<4, 1>;

estimate::Start<4> start_of(const FusedReading& reading) {
  estimate::Gaussian<4> start;
  start.mean << 0.0, reading.start_speed_mps.value, 0.0, reading.bias_mps2.value;
  start.cov.diagonal() << start_position_m2, std::pow(reading.start_speed_mps.std, 2),
      start_accel_m2ps4, std::pow(reading.bias_mps2.std, 2);
  return start;
}

std::vector<estimate::Epoch<1, 1>> epochs_of(const FusedReading& reading) {
  std::vector<estimate::Epoch<1, 1>> epochs(reading.time_s.size());
  const double settled = reading.bias_mps2.value + reading.bias_rise_mps2;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    // To the nanosecond: even time then has one model.
    if (k > 0)
      epochs[k].dt_s = std::round((reading.time_s[k] - reading.time_s[k - 1]) * 1e9) * 1e-9;
    epochs[k].z(0) = reading.accel_mps2[k];
    epochs[k].u(0) = settled;
  }
  return epochs;
}

void report(const Run& run, double variance_m2ps4, ThesisPaths& paths) {
  for (const auto& step : run.steps) {
    const auto& filtered = step.filtered;
    const auto& smoothed = step.smoothed;
    paths.filtered_m.push_back(filtered.mean(pva::position_m));
    paths.filtered_std_m.push_back(std::sqrt(filtered.cov(pva::position_m, pva::position_m)));
    paths.smoothed_m.push_back(smoothed.mean(pva::position_m));
    paths.smoothed_std_m.push_back(std::sqrt(smoothed.cov(pva::position_m, pva::position_m)));
    paths.filtered_accel_mps2.push_back(filtered.mean(pva::accel_mps2));
    paths.smoothed_accel_mps2.push_back(smoothed.mean(pva::accel_mps2));
    // K = P⁺ Hᵀ R⁻¹
    paths.gain.push_back((filtered.cov(pva::accel_mps2, pva::accel_mps2) +
                          filtered.cov(pva::accel_mps2, pva::bias_mps2)) /
                         variance_m2ps4);
  }
}

}  // namespace

Result<ThesisPaths> thesis_paths(const FusedReading& reading) {
  auto series = estimate::LinearSeries<4, 1, 1>::make(epochs_of(reading), [&](double dt_s) {
    return estimate::pva_bias_model({.motion = {.dt_s = dt_s,
                                                .jerk_psd_m2ps5 = jerk_psd_m2ps5,
                                                .accel_variance_m2ps4 = reading.variance_m2ps4},
                                     .time_constant_s = reading.time_constant_s,
                                     .bias_psd_m2ps5 = 0.0});
  });
  if (!series) return series.error();
  const Run run = estimate::smooth_linear(std::move(series).value(), start_of(reading),
                                          {.smoother = estimate::Smoother::rauch_tung_striebel});
  ThesisPaths paths;
  paths.integrated_m =
      integrated_twice(reading.time_s, reading.accel_mps2, reading.start_speed_mps.value);
  report(run, reading.variance_m2ps4, paths);
  return paths;
}

std::vector<double> integrated_twice(View<double> time_s, View<double> accel, double start_speed) {
  std::vector<double> path(time_s.size(), 0.0);
  double speed = start_speed, position = 0.0;
  std::size_t last = 0;  // with a reading
  while (last < accel.size() && std::isnan(accel[last])) ++last;
  for (std::size_t k = last + 1; k < accel.size(); ++k) {
    path[k] = position;
    if (std::isnan(accel[k])) continue;
    const double h = time_s[k] - time_s[last];
    position += h * speed + h * h * (2.0 * accel[last] + accel[k]) / 6.0;
    speed += h * (accel[last] + accel[k]) / 2.0;
    path[k] = position;
    last = k;
  }
  return path;
}

double gravity_path_m(const TurningGravity& gravity, double t_s) {
  const double turned = gravity.speed_radps * t_s;
  const double scale = gravity.gravity_mps2 / (gravity.speed_radps * gravity.speed_radps);
  return scale * (std::cos(gravity.phase_rad) - std::cos(turned + gravity.phase_rad) -
                  turned * std::sin(gravity.phase_rad));
}

}  // namespace proofmass::thesis
