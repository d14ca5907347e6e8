#include "proofmass/estimate/wheel/gravity_fit.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/random.hpp"

namespace proofmass::estimate::gravity_fit_test {
namespace {

constexpr double gravity = standard_gravity_mps2, rate_hz = 400.0, duration_s = 40.0;

/// A wheel pushed by hand, whose speed varies by a third.
struct Pushes {
  static constexpr double speed = 6.0, part = 2.0, push_radps = 4.0;

  static double angle(double t) {
    return speed * t - part / push_radps * std::cos(push_radps * t) + 0.4 * std::sin(0.3 * t) / 0.3;
  }
  static double accel(double t) {
    return part * push_radps * std::cos(push_radps * t) - 0.12 * std::sin(0.3 * t);
  }
};

/// An encoder off its axle, and a sensor whose filter delays it, on a wheel of a vehicle.
struct Truth {
  double delay_s = 0.006, rolling_m = 0.35, cosine_rad = 0.008, sine_rad = -0.005;

  [[nodiscard]] signal::AngleFixes fixes() const {
    signal::AngleFixes fixes;
    for (double t = 0.0; t < duration_s; t += 1.0 / rate_hz) {
      const double angle = Pushes::angle(t);
      double shown = angle;
      for (int k = 0; k < 10; ++k)
        shown = angle + cosine_rad * std::cos(shown) + sine_rad * std::sin(shown);
      fixes.time_s.push_back(t);
      fixes.angle_rad.push_back(shown);
      fixes.std_rad.push_back(1e-3);
    }
    return fixes;
  }

  [[nodiscard]] WheelReadings readings() const {
    WheelReadings readings;
    PlanarReadings sensor;
    Random random(1, "sensor");
    for (double t = 1.0; t < duration_s - 1.0; t += 1.0 / rate_hz) {
      const double at =
          Pushes::angle(t - delay_s) - rolling_m * Pushes::accel(t - delay_s) / gravity;
      WheelEpoch epoch;
      epoch.row[0] = static_cast<std::int64_t>(readings.time_s.size());
      readings.time_s.push_back(t);
      readings.epochs.push_back(epoch);
      sensor.u_mps2.push_back(gravity * std::sin(at) + 0.2 * random.normal());
      sensor.v_mps2.push_back(gravity * std::cos(at) + 0.2 * random.normal());
    }
    readings.sensors.push_back(std::move(sensor));
    return readings;
  }
};

// Without what delay and encoder errors change in the hub's acceleration, the steps of Gauss-Newton
// drifted away from the smallest residuals: the rolling radius from 0.37 to 0.1 m.
TEST(GravityFit, ConvergesUnderPushes) {
  const Truth truth;
  const WheelReadings readings = truth.readings();
  const signal::AngleFixes fixes = truth.fixes();
  GravityFit fit({0.01, 0.01}, uncalibrated_errors_rad, false, gravity);
  int rounds = 0;
  for (; rounds < 12 && fit.last_move() > 1e-2; ++rounds)
    fit.step(readings,
             motion_of(fit.corrected(fixes), readings.time_s, fit.figure(GravityFit::delay).value));
  EXPECT_LT(rounds, 9);
  EXPECT_NEAR(fit.variance_m2ps4(), 0.04, 0.01);
  EXPECT_NEAR(fit.figure(GravityFit::delay).value, truth.delay_s, 5e-4);
  EXPECT_NEAR(fit.figure(GravityFit::radius).value, truth.rolling_m, 0.1 * truth.rolling_m);
  EXPECT_NEAR(fit.figure(GravityFit::errors).value, truth.cosine_rad, 1e-3);
  EXPECT_NEAR(fit.figure(GravityFit::errors + 1).value, truth.sine_rad, 1e-3);
}

// The derivatives of which the steps are made, by differences of whole models.
TEST(GravityFit, KnowsWhatDelayAndErrorsChange) {
  const Truth truth;
  const WheelReadings readings = truth.readings();
  const signal::AngleFixes fixes = truth.fixes();
  GravityFit fit({0.01, 0.01}, uncalibrated_errors_rad, false, gravity);
  for (int round = 0; round < 8; ++round)
    fit.step(readings,
             motion_of(fit.corrected(fixes), readings.time_s, fit.figure(GravityFit::delay).value));
  const double delay_s = fit.figure(GravityFit::delay).value, step_s = 1e-3;
  const auto at = [&](double more_s) {
    return motion_of(fit.corrected(fixes), readings.time_s, delay_s + more_s);
  };
  const auto now = at(0.0), early = at(-step_s), late = at(step_s);
  double squares = 0.0, differences = 0.0;
  for (std::size_t k = 400; k + 400 < now.size(); k += 7) {
    const Mat<2> nothing = Mat<2>::Zero();
    const Mat<2> change =
        (fit.residual_of(nothing, early[k]).off - fit.residual_of(nothing, late[k]).off) /
        (2.0 * step_s);
    const Mat<2> known =
        fit.residual_of(nothing, now[k]).by_parameters.row(GravityFit::delay).transpose();
    squares += change.squaredNorm();
    differences += (change - known).squaredNorm();
  }
  EXPECT_LT(differences, 0.01 * squares);
}

}  // namespace
}  // namespace proofmass::estimate::gravity_fit_test
