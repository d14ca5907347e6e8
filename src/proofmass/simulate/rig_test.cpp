#include "proofmass/simulate/rig.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/statistics.hpp"
#include "proofmass/simulate/rig/perfect_rig.hpp"
#include "proofmass/simulate/wheel_motion.hpp"

namespace proofmass::simulate::rig_test {
namespace {

TEST(Rig, DefaultIsTheThesissWheel) {
  const RigResult rig = simulated(RigOptions{});
  EXPECT_EQ(rig.recording.samples(), 12000U);
  EXPECT_EQ(rig.recording.time.rate_hz, 200.0);
  ASSERT_EQ(rig.recording.channels.size(), 6U);
  EXPECT_EQ(accelerometer_triads(rig.recording).size(), 2U);
  EXPECT_EQ(rig.recording.channels[3].name, "acc2_x");
  EXPECT_EQ(rig.recording.channels[0].unit, parse_unit("m/s^2").value());
  EXPECT_NEAR(column(rig.truth, "angle").back() / rad_per_turn, 11.0, 0.02);
  EXPECT_NEAR(moments(column(rig.truth, "speed")).mean, 1.1519, 0.001);
  EXPECT_NEAR(moments(column(rig.truth, "speed")).std(), 0.02 / std::numbers::sqrt2 * 1.1519,
              0.0005);
  EXPECT_EQ(rig.sensors.size(), 2U);
}

// methods/wheel.md: half-sum g (sin θ, cos θ), half-difference (−Rω², Rα).
TEST(Rig, HalfSumIsGravityAndHalfDifferenceTheMotion) {
  const RigResult rig = simulated(perfect());
  for (std::size_t k = 0; k < rig.recording.samples(); ++k) {
    const double theta = column(rig.truth, "angle")[k], w = column(rig.truth, "speed")[k],
                 al = column(rig.truth, "acceleration")[k];
    const double x1 = column(rig.recording, "acc1_x")[k], x2 = column(rig.recording, "acc2_x")[k];
    const double y1 = column(rig.recording, "acc1_y")[k], y2 = column(rig.recording, "acc2_y")[k];
    ASSERT_NEAR(0.5 * (x1 + x2), g * std::sin(theta), 1e-12);
    ASSERT_NEAR(0.5 * (y1 + y2), g * std::cos(theta), 1e-12);
    ASSERT_NEAR(0.5 * (x1 - x2), -0.1 * w * w, 1e-12);
    ASSERT_NEAR(0.5 * (y1 - y2), 0.1 * al, 1e-12);
    ASSERT_NEAR(column(rig.recording, "acc1_z")[k], 0.0, 1e-12);
  }
}

// Bias and warm-up limit a plain atan2 of the two sensors' sum (methods/wheel.md: 0.99° rms as the
// mean of three seeds): to first order by (b_x cos θ − b_y sin θ)/g, b the true mean bias.
TEST(Rig, TruthsBiasesExplainTheErrorOfAPlainAtan2) {
  Moments rms_deg;
  RigOptions options;
  for (options.seed = 1; options.seed <= 30; ++options.seed) {
    const RigResult rig = simulated(options);
    Moments squares, explained;
    for (std::size_t k = 0; k < rig.recording.samples(); k += 5) {
      const auto at = [&](std::size_t c) { return rig.recording.channels[c].values[k]; };
      const auto truth = [&](std::size_t c) { return rig.truth.channels[c].values[k]; };
      const double error =
          std::remainder(std::atan2(at(0) + at(3), at(1) + at(4)) - truth(0), rad_per_turn);
      squares.add(error * error);
      const double bx = 0.5 * (truth(3) + truth(6)), by = 0.5 * (truth(4) + truth(7));
      explained.add(std::pow((bx * std::cos(truth(0)) - by * std::sin(truth(0))) / g, 2));
    }
    EXPECT_NEAR(std::sqrt(squares.mean), std::sqrt(explained.mean), 6e-4);
    rms_deg.add(std::sqrt(squares.mean) / rad_per_deg);
  }
  EXPECT_GT(rms_deg.mean, 0.5);
  EXPECT_LT(rms_deg.max, 2.0);
}

TEST(Rig, SensorTurnedHalfATurnReadsItsOwnOutwardAxis) {
  RigOptions options = perfect();
  const RigResult parallel = simulated(options);
  options.sensors[1].mounting_rad = std::numbers::pi;
  const RigResult turned = simulated(options);
  for (std::size_t k = 0; k < 2000; ++k) {
    ASSERT_NEAR(column(turned.recording, "acc2_x")[k], -column(parallel.recording, "acc2_x")[k],
                1e-12);
    ASSERT_NEAR(column(turned.recording, "acc2_y")[k], -column(parallel.recording, "acc2_y")[k],
                1e-12);
  }
}

TEST(Rig, AngleOfTheTruthIsThatOfTheFirstSensorsXAxis) {
  RigOptions options = perfect();
  options.wheel.profile = {{.duration_s = 1.0}};
  options.wheel.start_angle_rad = 0.2;
  options.sensors[0].mounting_rad = 0.3;
  const RigResult rig = simulated(options);
  EXPECT_DOUBLE_EQ(column(rig.truth, "angle")[0], 0.5);
  EXPECT_NEAR(column(rig.recording, "acc1_x")[0], g * std::sin(0.5), 1e-12);
  EXPECT_NEAR(column(rig.recording, "acc1_y")[0], g * std::cos(0.5), 1e-12);
}

// Second computation, from the path of the proof mass: f = p̈ − gravity by second differences.
TEST(Rig, ForceIsThePathsSecondDerivativeLessGravity) {
  RigOptions options = perfect();
  options.wheel.ripple = {.fraction = 0.07, .order = 2.0};
  options.wheel.profile = {{.duration_s = 6.0, .speed_radps = 3.0, .ramp_s = 6.0}};
  options.wheel.rolling_radius_m = 0.31;
  options.wheel.start_angle_rad = 0.4;
  RigSensor& sensor = options.sensors[0];
  sensor.radius_m = 0.23;
  sensor.position_rad = 1.1;
  sensor.mounting_rad = -0.7;
  const RigResult rig = simulated(options);
  const WheelMotion motion(0.4, options.wheel.profile, options.wheel.ripple, options.seed);
  // Rolling without slip on the ground below: the hub moves backwards as the angle increases.
  const auto path = [&](double t) {
    const double at = motion.at(t).angle_rad;
    return std::pair{-0.31 * at + 0.23 * std::cos(at + 1.1), 0.23 * std::sin(at + 1.1)};
  };
  constexpr double h = 1e-3;
  for (std::size_t k = 1; k + 1 < rig.recording.samples(); k += 7) {
    const double t = rig.recording.time.at(k);
    const auto [x0, y0] = path(t - h);
    const auto [x1, y1] = path(t);
    const auto [x2, y2] = path(t + h);
    const double horizontal = (x0 - 2 * x1 + x2) / (h * h);
    const double upward = (y0 - 2 * y1 + y2) / (h * h) + g;
    const double axis = motion.at(t).angle_rad - 0.7;
    ASSERT_NEAR(column(rig.recording, "acc1_x")[k],
                horizontal * std::cos(axis) + upward * std::sin(axis), 1e-4);
    ASSERT_NEAR(column(rig.recording, "acc1_y")[k],
                -horizontal * std::sin(axis) + upward * std::cos(axis), 1e-4);
  }
}

TEST(Rig, TiltedAxleMovesGravityIntoTheSpinAxis) {
  RigOptions options = perfect();
  options.wheel.axle_tilt_rad = 0.1;
  options.sensors[0].radius_m = 0.0;
  const RigResult rig = simulated(options);
  for (std::size_t k = 0; k < rig.recording.samples(); k += 11) {
    const double x = column(rig.recording, "acc1_x")[k], y = column(rig.recording, "acc1_y")[k];
    ASSERT_NEAR(std::hypot(x, y), g * std::cos(0.1), 1e-12);
    ASSERT_NEAR(column(rig.recording, "acc1_z")[k], g * std::sin(0.1), 1e-12);
  }
}

// Tilting the board by small angles rotates its z axis towards x (about y) and −y (about x).
TEST(Rig, TiltedBoardKeepsTheLengthOfTheForce) {
  RigOptions options = perfect();
  options.sensors[0].tilt_y_rad = 0.02;
  options.sensors[0].tilt_x_rad = -0.03;
  const RigResult rig = simulated(options), level = simulated(perfect());
  for (std::size_t k = 0; k < rig.recording.samples(); k += 13) {
    const double x = column(level.recording, "acc1_x")[k], y = column(level.recording, "acc1_y")[k];
    const double zt = column(rig.recording, "acc1_z")[k];
    ASSERT_NEAR(zt, x * std::cos(-0.03) * std::sin(0.02) - y * std::sin(-0.03), 1e-12);
    ASSERT_NEAR(
        std::hypot(column(rig.recording, "acc1_x")[k], column(rig.recording, "acc1_y")[k], zt),
        std::hypot(x, y), 1e-12);
  }
}

TEST(Rig, ShakeOfTheHubHasItsRmsAndReachesBothSensorsAlike) {
  RigOptions options = perfect();
  options.wheel.profile = {{.duration_s = 100.0}};
  const RigResult still = simulated(options);
  options.wheel.shake_horizontal_rms_mps2 = 2.0;
  options.wheel.shake_vertical_rms_mps2 = 3.0;
  const RigResult rig = simulated(options);
  // At rest at angle 0: x is horizontal, y upward.
  EXPECT_NEAR(moments(column(rig.recording, "acc1_x")).std(), 2.0, 0.1);
  EXPECT_NEAR(moments(column(rig.recording, "acc1_y")).std(), 3.0, 0.15);
  EXPECT_NEAR(column(still.recording, "acc1_y")[7], g, 1e-12);
  for (std::size_t k = 0; k < rig.recording.samples(); k += 101)
    ASSERT_NEAR(column(rig.recording, "acc1_x")[k], column(rig.recording, "acc2_x")[k], 1e-12);
}

TEST(Rig, BiasesAreDrawnWithinTheirSpread) {
  Moments drawn;
  RigOptions options;
  options.wheel.profile = {{.duration_s = 0.005}};
  for (options.seed = 0; options.seed < 300; ++options.seed) {
    const RigResult rig = simulated(options);
    for (std::size_t i = 3; i < 9; ++i) drawn.add(rig.truth.channels[i].values[0]);
  }
  EXPECT_LE(drawn.max, 0.3);
  EXPECT_GE(drawn.min, -0.3);
  EXPECT_NEAR(drawn.std(), 0.3 / std::sqrt(3.0), 0.01);
}

TEST(Rig, ReadingLessTruthIsTheNoise) {
  RigOptions options = perfect();
  options.wheel.profile = {{.duration_s = 100.0, .speed_radps = 1.0}};
  const RigResult clean = simulated(options);
  options.bias_spread_mps2 = 0.3;
  options.sensors[0].warm_up_mps2 = {0.1, 0.1, 0.1};
  options.sensors[0].bias_walk_mps2_rts = {0.01, 0.01, 0.01};
  options.sensors[0].noise_rms_mps2 = {0.0184, 0.0184, 0.0184};
  const RigResult rig = simulated(options);
  std::vector<double> rest(rig.recording.samples());
  for (std::size_t k = 0; k < rest.size(); ++k)
    rest[k] = column(rig.recording, "acc1_x")[k] - column(clean.recording, "acc1_x")[k] -
              column(rig.truth, "bias1_x")[k];
  EXPECT_NEAR(moments(rest).mean, 0.0, 5 * 0.0184 / std::sqrt(20000.0));
  EXPECT_NEAR(moments(rest).std(), 0.0184, 5 * 0.0184 / std::sqrt(40000.0));
}

TEST(Rig, SameSeedSameNumbers) {
  RigOptions options;
  options.wheel.profile[0].duration_s = 1.0;
  options.datasheet_errors = true;
  const RigResult a = simulated(options), b = simulated(options);
  options.seed = 2;
  const RigResult c = simulated(options);
  EXPECT_EQ(a.recording.channels[0].values, b.recording.channels[0].values);
  EXPECT_EQ(a.truth.channels[0].values, b.truth.channels[0].values);
  EXPECT_NE(a.recording.channels[0].values, c.recording.channels[0].values);
}

TEST(Rig, OneEffectLeavesTheNumbersOfTheOthersAlone) {
  RigOptions options;
  options.wheel.profile[0].duration_s = 1.0;
  options.sensors[0].filter_signal = false;  // which would filter the walk too
  const RigResult before = simulated(options);
  options.sensors[0].bias_walk_mps2_rts = {0.1, 0.1, 0.1};
  const RigResult after = simulated(options);
  for (std::size_t k = 0; k < 200; ++k)
    ASSERT_NEAR(column(after.recording, "acc1_x")[k] - column(before.recording, "acc1_x")[k],
                column(after.truth, "bias1_x")[k] - column(before.truth, "bias1_x")[k], 1e-12);
  EXPECT_EQ(column(after.recording, "acc2_y"), column(before.recording, "acc2_y"));
}

TEST(Rig, RecordsTwoAxesAndOneSensorIfAsked) {
  RigOptions options = perfect();
  options.axes = 2;
  options.sensors.resize(1);
  const RigResult rig = simulated(options);
  ASSERT_EQ(rig.recording.channels.size(), 2U);
  EXPECT_EQ(rig.recording.channels[1].name, "acc1_y");
  EXPECT_EQ(rig.truth.channels.size(), 5U);
}

TEST(Rig, TellsItsProgress) {
  RigOptions options;
  options.wheel.profile[0].duration_s = 0.1;
  double last = -1.0;
  ASSERT_TRUE(simulate_rig(options, [&](std::string_view, double fraction) {
    EXPECT_GT(fraction, last);
    last = fraction;
  }));
  EXPECT_EQ(last, 1.0);
}

TEST(Rig, SaysWhichOptionMakesNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](std::string_view key, auto spoil) {
    RigOptions options;
    spoil(options);
    const auto rig = simulate_rig(options);
    ASSERT_FALSE(rig) << key;
    EXPECT_EQ(rig.error().code, Errc::invalid_argument);
    EXPECT_TRUE(rig.error().message.starts_with(key)) << rig.error().message;
  };
  refuses("rate_hz", [](RigOptions& o) { o.rate_hz = 0.0; });
  refuses("gravity_mps2", [=](RigOptions& o) { o.gravity_mps2 = nan; });
  refuses("axes", [](RigOptions& o) { o.axes = 1; });
  refuses("bias_spread_mps2", [](RigOptions& o) { o.bias_spread_mps2 = -1.0; });
  refuses("sensor", [](RigOptions& o) { o.sensors.clear(); });
  refuses("sensor", [](RigOptions& o) { o.sensors.resize(10); });
  refuses("segment", [](RigOptions& o) { o.wheel.profile.clear(); });
  refuses("duration_s", [](RigOptions& o) { o.wheel.profile[0].duration_s = 0.0; });
  refuses("duration_s", [](RigOptions& o) { o.wheel.profile[0].duration_s = 1e9; });
  refuses("ramp_s", [](RigOptions& o) { o.wheel.profile[0].ramp_s = 61.0; });
  refuses("order", [](RigOptions& o) { o.wheel.ripple.order = 0.0; });
  refuses("fraction", [](RigOptions& o) { o.wheel.ripple.fraction = -0.1; });
  refuses("shake_bandwidth_hz", [](RigOptions& o) { o.wheel.shake_bandwidth_hz = 0.0; });
  refuses("bias_mps2", [=](RigOptions& o) { o.sensors[1].bias_mps2[2] = nan; });
  refuses("scale", [](RigOptions& o) { o.sensors[0].scale[1] = 0.0; });
  refuses("radius_m", [](RigOptions& o) { o.sensors[0].radius_m = -0.1; });
  refuses("noise_rms_mps2", [](RigOptions& o) { o.sensors[0].noise_rms_mps2[0] = -1.0; });
  refuses("warm_up_time_s", [](RigOptions& o) { o.sensors[0].warm_up_time_s = 0.0; });
  refuses("bits", [](RigOptions& o) { o.daq.bits = 33; });
  refuses("min_v", [](RigOptions& o) { o.daq.min_v = 5.0; });
  refuses("output", [](RigOptions& o) { o.output = RigOutput::counts; });
  refuses("skew_s", [](RigOptions& o) { o.daq.skew_s = 1e-3; });
  refuses("nominal_v", [](RigOptions& o) { o.supply.nominal_v = 0.0; });
}

}  // namespace
}  // namespace proofmass::simulate::rig_test
