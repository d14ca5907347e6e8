// An online filter for a robot: one measurement at a time, without allocation. A cart is pushed
// along its rail and stops now and then; its accelerometer has a bias, and when the cart is known
// to be at rest, this is applied as a measurement of its speed, 0. The smoothed state is available
// half a second later.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>

#include "proofmass/estimate/filter/live_filter.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace pm = proofmass::estimate;
namespace pva = proofmass::estimate::pva;

namespace {

constexpr double accel_std_mps2 = 0.02, standstill_std_mps = 0.001, bias_mps2 = 0.05;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Position, velocity, acceleration and bias; measured are the acceleration and, at rest, the
// velocity.
pm::LinearModel<4, 2, 1> cart(double dt_s) {
  const auto motion = pm::pva_bias_model(
      {.motion = {.dt_s = dt_s, .jerk_psd_m2ps5 = 2.0, .accel_variance_m2ps4 = 4e-4},
       .time_constant_s = 600.0,
       .bias_psd_m2ps5 = 1e-9});
  pm::LinearModel<4, 2, 1> model{.F = motion.F, .Q = motion.Q, .H = {}, .R = {}, .B = motion.B};
  model.H << motion.H, 0.0, 1.0, 0.0, 0.0;
  model.R << accel_std_mps2 * accel_std_mps2, standstill_std_mps * standstill_std_mps;
  return model;
}

// Two seconds of rest, then 1 m in two seconds, and so on.
struct Truth {
  double position_m, accel_mps2;
  bool rest;
};
Truth truth_at(double t_s) {
  const double stage = std::floor(t_s / 4.0), t = t_s - 4.0 * stage - 2.0;
  if (t < 0.0) return {stage, 0.0, true};
  const double angle = std::numbers::pi * t;
  return {stage + t / 2.0 - std::sin(angle) / (2.0 * std::numbers::pi),
          std::numbers::pi / 2.0 * std::sin(angle), false};
}

}  // namespace

int main() {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> jitter(0.008, 0.012);

  pm::Gaussian<4> start;  // at rest at the origin, the bias known to 0.1 m/s²
  start.cov(pva::bias_mps2, pva::bias_mps2) = 0.01;
  pm::LiveFilter<4, 2, 1> filter(start, {.gate = {.limit = 8.0}, .lag = 50});

  double t_s = 0.0, next_print_s = 1.0, worst = 0.0;
  while (t_s < 20.0) {
    const double dt_s = jitter(rng);
    t_s += dt_s;
    const Truth truth = truth_at(t_s);
    pm::Epoch<2, 1> epoch{.dt_s = dt_s, .z = {}, .u = {}};
    epoch.z << truth.accel_mps2 + bias_mps2 + accel_std_mps2 * noise(rng),
        truth.rest ? standstill_std_mps * noise(rng) : none;
    epoch.u << 0.0;  // level to which the bias settles, if it were known
    if (const auto status = filter.step(cart(dt_s), epoch); !status) {
      std::printf("%s\n", status.error().message.c_str());
      return 1;
    }
    const auto& now = filter.state();
    const double std_m = std::sqrt(now.cov(pva::position_m, pva::position_m));
    const double error_m = now.mean(pva::position_m) - truth.position_m;
    worst = std::max(worst, std::abs(error_m) / std::max(std_m, 1e-6));
    if (t_s < next_print_s) continue;
    next_print_s += 1.0;
    const auto& later = *filter.lagged();
    std::printf(
        "%5.2f s  %s  %7.4f ± %.4f m, in truth off by %+.4f m; 50 readings ago ± %.4f m; "
        "bias %+.4f ± %.4f m/s²\n",
        t_s, truth.rest ? "rests" : "moves", now.mean(pva::position_m), std_m, error_m,
        std::sqrt(later.cov(pva::position_m, pva::position_m)), now.mean(pva::bias_mps2),
        std::sqrt(now.cov(pva::bias_mps2, pva::bias_mps2)));
  }
  return worst < 5.0 ? 0 : 1;
}
