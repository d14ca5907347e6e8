#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/sensor/calibration.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig/perfect_rig.hpp"

namespace proofmass::simulate::rig_electronics_test {
namespace {

// 1 g at 3.3 V is 1.98 V, −1 g 1.32 V; the thesis prints 1.98 V for −1 g.
TEST(RigElectronics, WritesVoltsOfTheThesissSensor) {
  RigOptions options = perfect();
  options.output = RigOutput::voltage;
  options.wheel.start_angle_rad = std::numbers::pi / 2.0;
  options.wheel.profile = {{.duration_s = 0.1}};
  const RigResult rig = simulated(options);
  EXPECT_NEAR(column(rig.recording, "acc1_x")[0], 1.98, 1e-12);
  EXPECT_NEAR(column(rig.recording, "acc1_y")[0], 1.65, 1e-12);
  EXPECT_EQ(rig.recording.channels[0].unit, parse_unit("V").value());
}

TEST(RigElectronics, ConvertersGridAndLimitsHold) {
  RigOptions options;
  options.wheel.profile[0].duration_s = 5.0;
  options.output = RigOutput::counts;
  options.daq = {.bits = 10, .min_v = 0.0, .max_v = 3.3};
  const RigResult counts = simulated(options);
  options.output = RigOutput::voltage;
  const RigResult volts = simulated(options);
  options.daq.bits = 0;
  const RigResult exact = simulated(options);
  double worst = 0.0;
  for (std::size_t k = 0; k < counts.recording.samples(); ++k) {
    const double code = column(counts.recording, "acc1_x")[k];
    const double v = column(volts.recording, "acc1_x")[k];
    ASSERT_EQ(code, std::round(code));
    ASSERT_NEAR(v, code * 3.3 / 1024.0, 1e-12);
    worst = std::max(worst, std::abs(v - column(exact.recording, "acc1_x")[k]));
  }
  EXPECT_LE(worst, 0.5 * 3.3 / 1024.0 + 1e-12);
  EXPECT_GT(worst, 0.49 * 3.3 / 1024.0);

  options.daq = {.bits = 10, .min_v = 1.6, .max_v = 1.8};
  const Moments clipped = moments(column(simulated(options).recording, "acc1_x"));
  const double lsb = 0.2 / 1024.0;
  EXPECT_NEAR(clipped.min, 1.6, 1e-12);
  EXPECT_NEAR(clipped.max, 1.8 - lsb, 1e-12);
}

TEST(RigElectronics, SkewedChannelsAreSampledOneAfterTheOther) {
  RigOptions options = perfect();
  options.wheel.profile = {{.duration_s = 5.0, .speed_radps = 2.0}};
  options.wheel.ripple = {};
  options.daq.skew_s = 5e-4;
  const double full_scale = options.sensors[1].full_scale_mps2;
  options.sensors[1].warm_up_mps2 = {0.0, 0.0, 50.0};
  options.sensors[1].warm_up_time_s = 1.0;
  const RigResult rig = simulated(options);
  for (std::size_t k = 0; k < rig.recording.samples(); k += 17) {
    const double t = rig.recording.time.at(k);
    ASSERT_NEAR(column(rig.recording, "acc1_x")[k], g * std::sin(2.0 * t) - 0.4, 1e-12);
    ASSERT_NEAR(column(rig.recording, "acc1_y")[k], g * std::cos(2.0 * (t + 5e-4)), 1e-12);
    ASSERT_NEAR(column(rig.recording, "acc2_y")[k], g * std::cos(2.0 * (t + 4 * 5e-4)), 1e-12);
    ASSERT_NEAR(column(rig.truth, "angle")[k], 2.0 * t, 1e-12);
    // The truth is at the time of the scan, the sample at its own time.
    ASSERT_NEAR(column(rig.truth, "bias2_z")[k], 50.0 * (1.0 - std::exp(-t)), 1e-12);
    const double own_bias = 50.0 * (1.0 - std::exp(-(t + 5 * 5e-4)));
    ASSERT_NEAR(column(rig.recording, "acc2_z")[k], std::min(own_bias, full_scale), 1e-12);
  }
}

TEST(RigElectronics, FilterDelaysTheSignalByItsTimeConstant) {
  RigOptions options = perfect();
  options.wheel.profile = {{.duration_s = 5.0, .speed_radps = 2.0}};
  options.wheel.ripple = {};
  options.sensors[0].filter_signal = true;
  options.sensors[0].bandwidth_hz = 50.0;
  const RigResult rig = simulated(options);
  const double ratio = 2.0 / (rad_per_turn * 50.0);  // ω/ω_c
  const double gain = 1.0 / std::hypot(1.0, ratio), lag = std::atan(ratio);
  for (std::size_t k = 50; k < rig.recording.samples(); k += 9)
    ASSERT_NEAR(column(rig.recording, "acc1_y")[k],
                gain * g * std::cos(2.0 * rig.recording.time.at(k) - lag), 1e-5);
}

TEST(RigElectronics, SupplyRippleShowsInTheVoltsAndIsUndoneByTheRecordedSupply) {
  RigOptions options = perfect();
  options.output = RigOutput::voltage;
  options.supply = {.nominal_v = 3.3, .ripple_rms_v = 0.05, .ripple_hz = 7.0, .recorded = true};
  RigResult rig = simulated(options);
  EXPECT_NEAR(moments(column(rig.recording, "supply")).std(), 0.05, 1e-3);
  options.output = RigOutput::acceleration;
  const RigResult uncorrected = simulated(options);
  options.supply.ripple_rms_v = 0.0;
  const RigResult clean = simulated(options);
  const auto triads = accelerometer_triads(rig.recording);
  ASSERT_TRUE(sensor::apply(rig.sensors[0], triads.at(0), rig.recording));
  double worst = 0.0;
  for (std::size_t k = 0; k < clean.recording.samples(); ++k) {
    const double truth = column(clean.recording, "acc1_x")[k];
    ASSERT_NEAR(column(rig.recording, "acc1_x")[k], truth, 1e-11);
    worst = std::max(worst, std::abs(column(uncorrected.recording, "acc1_x")[k] - truth));
  }
  EXPECT_GT(worst, 0.5 * 0.05 / 0.0337);
}

TEST(RigElectronics, NoiseDoesNotFollowTheSupply) {
  RigOptions options = perfect();
  const auto noise_with = [&](double ripple_rms_v) {
    options.supply.ripple_rms_v = ripple_rms_v;
    options.sensors[0].noise_rms_mps2 = {};
    const RigResult clean = simulated(options);
    options.sensors[0].noise_rms_mps2 = {1.0, 1.0, 1.0};
    std::vector<double> noise = column(simulated(options).recording, "acc1_x").copy();
    for (std::size_t k = 0; k < noise.size(); ++k) noise[k] -= column(clean.recording, "acc1_x")[k];
    return noise;
  };
  const auto steady = noise_with(0.0), rippled = noise_with(0.5);
  for (std::size_t k = 0; k < steady.size(); ++k) ASSERT_NEAR(steady[k], rippled[k], 1e-11);
}

// As in use: the twin's own sensor file converts its counts back to the forces.
TEST(RigElectronics, ItsSensorModelsTakeCountsBackToForces) {
  RigOptions options = perfect();
  const RigResult clean = simulated(options);
  options.bias_spread_mps2 = 0.3;
  options.sensors[1].scale = {1.05, 0.96, 1.01};
  options.sensors[1].misalignment_rad = {0.003, 0.002, -0.001};
  options.output = RigOutput::counts;
  options.daq.bits = 24;
  RigResult rig = simulated(options);
  const auto triads = accelerometer_triads(rig.recording);
  for (std::size_t i = 0; i < 2; ++i)
    ASSERT_TRUE(sensor::apply(rig.sensors[i], triads[i], rig.recording));
  for (std::size_t k = 0; k < clean.recording.samples(); k += 3)
    for (std::size_t c = 0; c < 6; ++c)
      ASSERT_NEAR(rig.recording.channels[c].values[k], clean.recording.channels[c].values[k], 3e-5);
}

}  // namespace
}  // namespace proofmass::simulate::rig_electronics_test
