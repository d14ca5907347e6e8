#include "proofmass/thesis/wheel/pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/wheel/model.hpp"

namespace proofmass::thesis {
namespace {

namespace wheel = estimate::wheel;
using Model = estimate::WheelModel<2>;
using Prior = estimate::FilterState<Model::states>;

constexpr std::size_t averaged = 2;
constexpr estimate::Gate open{};  // the twin's noise has no outliers

/// Factor on the measurement variance in the pass that finds the linearisation point: scale errors
/// of 10 % and an equal error of the angle make the first predictions wrong by many times the
/// noise.
constexpr double doubt = 100.0;

/// What a model needs to point at.
struct Readings {
  std::vector<double> time_s;
  std::vector<estimate::WheelEpoch> epochs;
  std::array<estimate::PlanarReadings, 2> sensors;
};

Readings readings_of(const WheelRecord& record, double variance_m2ps4) {
  Readings out;
  const std::vector<double>& time_s = record.sensors.front().time_s;
  const auto mean = [](const std::vector<double>& values, std::size_t first) {
    double sum = 0.0;
    for (std::size_t k = 0; k < averaged; ++k) sum += values[first + k];
    return sum / static_cast<double>(averaged);
  };
  for (std::size_t k = 0; k + averaged <= time_s.size(); k += averaged) {
    const auto row = static_cast<std::int64_t>(out.time_s.size());
    const double t_s = mean(time_s, k);
    out.epochs.push_back({.dt_s = row == 0 ? 0.0 : t_s - out.time_s.back(), .row = {row, row}});
    out.time_s.push_back(t_s);
    for (std::size_t s = 0; s < 2; ++s) {
      out.sensors[s].u_mps2.push_back(mean(record.sensors[s].accel_mps2[0], k));
      out.sensors[s].v_mps2.push_back(mean(record.sensors[s].accel_mps2[1], k));
      out.sensors[s].variance_m2ps4.push_back(variance_m2ps4);
    }
  }
  return out;
}

estimate::WheelNoise noise_of(const RigRun& run, const WheelRecord& record) {
  const double lasted_s = record.sensors.front().time_s.back();
  const double w = std::abs(run.speed_radps), leap_radps2 = w / ramp_s;
  const KnownBias& bias = record.bias.front().front();
  return {// Two steps of the acceleration.
          .jerk_psd = 2.0 * leap_radps2 * leap_radps2 / lasted_s,
          // (ripple ω⁴)²/2 over a bandwidth of ω/2.
          .snap_psd = std::pow(rig_ripple, 2) * std::pow(w, 7),
          .bias_walk_psd = std::pow(bias.rise_mps2 / bias.time_constant_s, 2) * lasted_s};
}

Prior prior_of(const Model& model, double radius_m) {
  Prior prior;
  auto& x = prior.x.mean;
  x(wheel::angle) = x(wheel::start) =
      std::atan2(model.readings[0]->u_mps2.front(), model.readings[0]->v_mps2.front());
  x(wheel::places(2)) = x(wheel::places(2) + 2) = radius_m;
  auto& P = prior.x.cov;
  // A bias of 0.5 m/s² against gravity.
  for (const int i : {wheel::angle, wheel::start})
    for (const int j : {wheel::angle, wheel::start}) P(i, j) = 0.05 * 0.05;
  auto variance = P.diagonal();
  variance(wheel::speed) = 1e-4;
  variance(wheel::accel) = variance(wheel::jerk) = 25.0;
  for (int s = 0; s < 2; ++s) {
    const int at = wheel::first_of(s);
    variance.segment<2>(at + wheel::bias).setConstant(0.5 * 0.5);
    variance.segment<2>(at + wheel::scale).setConstant(0.1 * 0.1);
    variance(at + wheel::skew) = 0.03 * 0.03;
  }
  variance(wheel::phase) = 0.05 * 0.05;
  return prior;
}

void run_over(const Model& model, const Prior& prior, WheelPass& pass, estimate::WheelPath& path) {
  path.moving.resize(model.size());
  pass.smoothed_accel_radps2.resize(model.size());
  pass.moved_std_rad.resize(model.size());
  for (auto* angle : {&pass.filtered, &pass.smoothed}) {
    angle->angle_rad.resize(model.size());
    angle->std_rad.resize(model.size());
  }
  estimate::smooth(
      model, prior, open,
      [&](std::size_t k, const estimate::StepOf<Model>& step) {
        pass.filtered.angle_rad[k] = step.filtered.mean(wheel::angle);
        pass.filtered.std_rad[k] = std::sqrt(step.filtered.cov(wheel::angle, wheel::angle));
        path.standing = step.filtered.mean.tail<wheel::standing(2)>();
      },
      [&](std::size_t k, const estimate::StepOf<Model>& step,
          const estimate::BackwardInformation<Model::states>& later) {
        path.moving[k] = later.mean(step.filtered).head<wheel::moving>();
        pass.smoothed_accel_radps2[k] = path.moving[k](wheel::accel);
        pass.smoothed.angle_rad[k] = path.moving[k](wheel::angle);
        const auto cov = later.cov<wheel::start + 1>(step.filtered);
        pass.smoothed.std_rad[k] = std::sqrt(cov(wheel::angle, wheel::angle));
        // Rounding may leave a hair below 0 at the first epoch.
        pass.moved_std_rad[k] = std::sqrt(std::max(0.0, cov(wheel::angle, wheel::angle) +
                                                            cov(wheel::start, wheel::start) -
                                                            2.0 * cov(wheel::angle, wheel::start)));
      });
}

}  // namespace

WheelPass wheel_pass(const RigRun& run, const WheelRecord& record) {
  const double noise_mps2 = rig_noise_mps2();
  // Two readings of one filter have a part of their noise in common.
  const double shared = std::exp(-rad_per_turn * rig_bandwidth_hz / rig_rate_hz);
  const double variance_m2ps4 = noise_mps2 * noise_mps2 * (1.0 + shared) / 2.0;
  const Readings readings = readings_of(record, variance_m2ps4);
  const Readings doubted = readings_of(record, doubt * variance_m2ps4);
  Model model;
  model.gravity_mps2 = run.gravity_mps2;
  model.phase_rad = std::numbers::pi;
  model.delay_s = 1.0 / (rad_per_turn * rig_bandwidth_hz);
  model.noise = noise_of(run, record);
  model.epochs = &readings.epochs;
  model.readings = {&readings.sensors[0], &readings.sensors[1]};
  model.places_held = true;
  const Prior prior = prior_of(model, rig_radius_m);
  WheelPass pass{.time_s = readings.time_s,
                 .filtered = {},
                 .smoothed = {},
                 .moved_std_rad = {},
                 .smoothed_accel_radps2 = {}};
  estimate::WheelPath about, path;
  run_over(model, prior, pass, path);
  const AngleEstimate live = pass.filtered;
  model.readings = {&doubted.sensors[0], &doubted.sensors[1]};
  run_over(model, prior, pass, about);
  model.readings = {&readings.sensors[0], &readings.sensors[1]};
  model.about = &about;
  run_over(model, prior, pass, path);
  pass.filtered = live;
  return pass;
}

}  // namespace proofmass::thesis
