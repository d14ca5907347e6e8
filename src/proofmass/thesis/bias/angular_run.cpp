#include "proofmass/thesis/bias/angular_run.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "proofmass/estimate/models/angular_model.hpp"

namespace proofmass::thesis {
namespace {

namespace angular = estimate::angular;

constexpr double jerk_psd_rad2ps5 = 1.0;  // W, "one rad per second"

void report(const estimate::LinearRun<4, 3>& run, AngularRun& out) {
  for (const auto& step : run.steps) {
    out.filtered_accel.push_back(step.filtered.mean(angular::accel_radps2));
    out.smoothed_accel.push_back(step.smoothed.mean(angular::accel_radps2));
    out.filtered_rad.push_back(step.filtered.mean(angular::angle_rad));
    out.smoothed_rad.push_back(step.smoothed.mean(angular::angle_rad));
    out.filtered_std_rad.push_back(
        std::sqrt(step.filtered.cov(angular::angle_rad, angular::angle_rad)));
  }
}

}  // namespace

Result<std::optional<AngularRun>> angular_run(const FirstTurn& turn) {
  const auto fused = fuse(turn, WheelAxis::forward, Fusion::gravity_cancelled);
  if (!fused || !turn.radius_m) return std::optional<AngularRun>{};
  const double radius_m = *turn.radius_m;
  AngularRun out;
  std::vector<estimate::Epoch<3, 1>> epochs(turn.size());
  double variance = 0.0;
  for (std::size_t k = 0; k < turn.size(); ++k) {
    const Uncertain accel =
        estimate::angular_accel({.first_mps2 = turn.force_mps2[0][1][k],
                                 .second_mps2 = turn.force_mps2[1][1][k],
                                 .variance_m2ps4 = turn.noise_mps2 * turn.noise_mps2,
                                 .radius_m = radius_m});
    out.raw_radps2.push_back(accel.value);
    variance = accel.std * accel.std;
    // To the nanosecond: even time then has one model.
    if (k > 0) epochs[k].dt_s = std::round((turn.time_s[k] - turn.time_s[k - 1]) * 1e9) * 1e-9;
    epochs[k].z.setConstant(std::numeric_limits<double>::quiet_NaN());
    epochs[k].z(angular::accel_channel) = accel.value;
    epochs[k].u(0) = (fused->bias_mps2.value + fused->bias_rise_mps2) / radius_m;
  }
  auto series = estimate::LinearSeries<4, 3, 1>::make(std::move(epochs), [&](double dt_s) {
    return estimate::angular_model({.dt_s = dt_s,
                                    .jerk_psd_rad2ps5 = jerk_psd_rad2ps5,
                                    .bias_time_constant_s = fused->time_constant_s,
                                    .accel_variance_rad2ps4 = variance});
  });
  if (!series) return Error(series.error()).at(turn.source);
  estimate::Gaussian<4> start;
  start.mean << 0.0, turn.speed_radps.front(), 0.0, fused->bias_mps2.value / radius_m;
  start.cov.diagonal() << 1e-12, std::pow(turn.start_speed_std_radps, 2), 100.0,
      std::pow(fused->bias_mps2.std / radius_m, 2);
  report(estimate::smooth_linear(std::move(series).value(), start,
                                 {.smoother = estimate::Smoother::rauch_tung_striebel}),
         out);
  return std::optional<AngularRun>(std::move(out));
}

}  // namespace proofmass::thesis
