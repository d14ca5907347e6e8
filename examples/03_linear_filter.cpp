// Position from an accelerometer alone, and its limits: a cart that moves to and fro, filtered and
// smoothed by the linear position–velocity–acceleration model. Without a position measurement the
// standard deviation of the position grows without bound.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <random>
#include <vector>

#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace pm = proofmass::estimate;

int main() {
  constexpr double dt_s = 0.01, noise_mps2 = 0.02;
  std::mt19937_64 rng(11);
  std::normal_distribution<double> noise(0.0, noise_mps2);

  // p = 1 − cos t, so a = cos t, from rest at the origin.
  std::vector<pm::Epoch<1>> epochs(2000);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    epochs[k].dt_s = dt_s;
    epochs[k].z(0) = std::cos(dt_s * static_cast<double>(k)) + noise(rng);
  }
  const auto model_at = [](double step_s) {
    return pm::pva_model(
        {.dt_s = step_s, .jerk_psd_m2ps5 = 0.02, .accel_variance_m2ps4 = noise_mps2 * noise_mps2});
  };
  const auto series = pm::LinearSeries<3, 1>::make(epochs, model_at).value();

  pm::Gaussian<3> start;  // at rest, the acceleration unknown
  start.cov(pm::pva::accel_mps2, pm::pva::accel_mps2) = 100.0;
  const auto run = pm::smooth_linear(series, start);

  bool covered = true;
  for (const std::size_t k : {std::size_t{100}, std::size_t{500}, epochs.size() - 1}) {
    const auto& smoothed = run.steps[k].smoothed;
    const double t_s = dt_s * static_cast<double>(k);
    const double std_m = std::sqrt(smoothed.cov(0, 0));
    const double error_m = smoothed.mean(0) - (1.0 - std::cos(t_s));
    covered = covered && std::abs(error_m) < 4.0 * std_m;
    std::printf(
        "after %5.2f s: position %7.3f m, standard deviation %.3f m, in truth off by %.3f m\n", t_s,
        smoothed.mean(0), std_m, error_m);
  }
  std::printf("mean NIS %.3f over %zu readings\n", run.nis / static_cast<double>(run.readings),
              run.readings);
  return covered ? 0 : 1;
}
