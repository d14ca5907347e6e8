#include "proofmass/simulate/slide.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <string>

#include "proofmass/sensor/calibration.hpp"
#include "proofmass/simulate/procedure_file.hpp"
#include "proofmass/simulate/rig/bench_test_support.hpp"

namespace proofmass::simulate::slide_test {
namespace {

constexpr double g = standard_gravity_mps2;

/// No noise and no errors: the recording is the force.
ProcedureOptions perfect() {
  ProcedureOptions options = noise_free(Procedure::slide);
  options.sensor.bias_spread_mps2 = 0.0;
  options.sensor.scale_spread = 0.0;
  options.sensor.misalignment_spread_rad = 0.0;
  options.sensor.full_scale_mps2 = 1e3;
  options.slide.gyro_bias_spread_radps = 0.0;
  options.slide.gyro_noise_rms_radps = 0.0;
  options.slide.gyro_walk_radps_rts = 0.0;
  return options;
}

/// Integral by the trapezoidal rule.
std::vector<double> integral(View<double> values, double step_s) {
  std::vector<double> sums{0.0};
  for (std::size_t k = 1; k < values.size(); ++k)
    sums.push_back(sums.back() + 0.5 * step_s * (values[k - 1] + values[k]));
  return sums;
}

double furthest(View<double> a, View<double> b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

TEST(Slide, RestsReadGravityInTheSensorsAxes) {
  ProcedureOptions options = perfect();
  options.slide.roll_rad = 0.3;
  options.slide.pitch_rad = -0.2;
  options.slide.yaw_rad = 1.0;
  const ProcedureResult result = simulated(options);
  ASSERT_EQ(result.truth.poses.size(), 7U);
  // Rᵀ e_z of R = Rz(yaw) Ry(pitch) Rx(roll).
  const Eigen::Vector3d up(-std::sin(-0.2), std::sin(0.3) * std::cos(-0.2),
                           std::cos(0.3) * std::cos(-0.2));
  for (const TruePose& rest : result.truth.poses)
    EXPECT_LT((rest.force_mps2 - g * up).norm(), 1e-12);
  EXPECT_LT((Triple(result.recording, "acc")(5) - g * up).norm(), 1e-12);
}

TEST(Slide, TheForceLessGravityIsTheAccelerationAlongTheLine) {
  ProcedureOptions options = perfect();
  options.slide.elevation_rad = 0.7;
  options.slide.any_mounting = true;
  const ProcedureResult result = simulated(options);
  const Triple acc(result.recording, "acc");
  const Samples& accel = column(result.truth_series, "acceleration");
  EXPECT_NEAR(result.truth.line.norm(), 1.0, 1e-12);
  EXPECT_NEAR(result.truth.line.dot(result.truth.poses[0].force_mps2), g * std::sin(0.7), 1e-12);
  for (std::size_t k = 0; k < accel.size(); ++k)
    EXPECT_LT((acc(k) - result.truth.poses[0].force_mps2 - accel[k] * result.truth.line).norm(),
              1e-11);
}

TEST(Slide, VelocityAndDisplacementAreTheIntegralsOfTheAcceleration) {
  for (const SlideProfile profile : {SlideProfile::minimum_jerk, SlideProfile::harmonic}) {
    ProcedureOptions options = perfect();
    options.rate_hz = 2000.0;
    options.slide.profile = profile;
    options.slide.repetitions = 2;
    options.slide.strokes = 2;
    const ProcedureResult result = simulated(options);
    const auto velocity = integral(column(result.truth_series, "acceleration"), 5e-4);
    const auto along = integral(column(result.truth_series, "velocity"), 5e-4);
    // The harmonic profile's force jumps at rests, by at most half a sample's worth of velocity.
    const double jump = profile == SlideProfile::harmonic ? 5e-3 : 1e-5;
    EXPECT_LT(furthest(velocity, column(result.truth_series, "velocity")), jump);
    EXPECT_LT(furthest(along, column(result.truth_series, "displacement")), 1e-5);
  }
}

TEST(Slide, StrokesGoThereAndBackAndEndWhereTheySay) {
  ProcedureOptions options = perfect();
  options.slide.strokes = 4;
  options.slide.length_jitter = 0.3;
  const ProcedureResult result = simulated(options);
  const Samples& along = column(result.truth_series, "displacement");
  ASSERT_EQ(result.truth.strokes.size(), 4U);
  for (const TrueStroke& stroke : result.truth.strokes) {
    EXPECT_NEAR(std::abs(stroke.to_m - stroke.from_m), 0.4, 0.12);
    const auto after = static_cast<std::size_t>(stroke.end_s * options.rate_hz) + 2;
    EXPECT_EQ(along[after], stroke.to_m);
    EXPECT_EQ(column(result.truth_series, "rest")[after], 1.0);
  }
  EXPECT_EQ(result.truth.strokes.back().to_m, 0.0);
  options.slide.returning = false;
  EXPECT_GT(simulated(options).truth.strokes.back().to_m, 1.1);
}

TEST(Slide, RepetitionsFollowEachOtherWithoutARest) {
  ProcedureOptions options = perfect();
  options.slide.strokes = 1;
  options.slide.repetitions = 5;
  options.slide.profile = SlideProfile::harmonic;
  options.slide.elevation_rad = 90.0 * rad_per_deg;
  options.timing.move_jitter = 0.0;
  const ProcedureResult result = simulated(options);
  ASSERT_EQ(result.truth.poses.size(), 2U);
  ASSERT_EQ(result.truth.strokes.size(), 10U);
  for (std::size_t k = 1; k < 10; ++k)
    EXPECT_EQ(result.truth.strokes[k].start_s, result.truth.strokes[k - 1].end_s);
  // At the bottom the force is at its maximum: π²/2 · L/T² in addition to gravity.
  const auto bottom = static_cast<std::size_t>((4.0 + 2.0) * options.rate_hz);
  EXPECT_NEAR(column(result.recording, "acc_z")[bottom],
              g + 0.5 * std::numbers::pi * std::numbers::pi * 0.4, 1e-9);
}

TEST(Slide, AGyroscopeIntegratesToTheTurnBetweenRests) {
  ProcedureOptions options = perfect();
  options.rate_hz = 500.0;
  options.slide.strokes = 1;
  options.slide.turn_std_rad = 0.05;
  options.slide.wobble_rms_rad = 0.02;
  options.slide.gyro = true;
  const ProcedureResult result = simulated(options);
  const Triple gyro(result.recording, "gyro");
  // Small consecutive steps: up' = up × ω.
  Eigen::Vector3d up = result.truth.poses[0].force_mps2.normalized();
  for (std::size_t k = 1; k < gyro.x.size(); ++k) {
    const Eigen::Vector3d step = 0.5 * (gyro(k - 1) + gyro(k)) / options.rate_hz;
    up = (up + up.cross(step) + 0.5 * up.cross(step).cross(step)).eval();
  }
  EXPECT_LT((up - result.truth.poses[1].force_mps2.normalized()).norm(), 1e-5);
  EXPECT_GT((up - result.truth.poses[0].force_mps2.normalized()).norm(), 1e-2);
  EXPECT_GT(column(result.truth_series, "turn").back(), 1e-2);
}

TEST(Slide, ASecondSensorFeelsTheSameButForTheTurningOfItsPlace) {
  ProcedureOptions options = perfect();
  options.slide.second_sensor = true;
  const ProcedureResult steady = simulated(options);
  const Triple first(steady.recording, "acc"), second(steady.recording, "acc2");
  for (std::size_t k = 0; k < first.x.size(); ++k) EXPECT_EQ(first(k), second(k));
  options.slide.wobble_rms_rad = 0.05;
  options.slide.second_place_m = {0.0, 0.3, 0.0};
  const ProcedureResult wobbling = simulated(options);
  double most = 0.0;
  for (std::size_t k = 0; k < first.x.size(); ++k)
    most = std::max(
        most,
        (Triple(wobbling.recording, "acc")(k) - Triple(wobbling.recording, "acc2")(k)).norm());
  EXPECT_GT(most, 0.1);
}

TEST(Slide, ErrorsOfTheSecondSensorAreItsOwn) {
  ProcedureOptions options = default_options(Procedure::slide);
  options.slide.second_sensor = true;
  const ProcedureResult result = simulated(options);
  EXPECT_NE(column(result.recording, "acc_x")[0], column(result.recording, "acc2_x")[0]);
  options.slide.second_sensor = false;
  EXPECT_EQ(column(simulated(options).recording, "acc_x"), column(result.recording, "acc_x"));
}

TEST(Slide, GravityRemovedLeavesMotionAndTheSensorsErrors) {
  ProcedureOptions options = perfect();
  options.sensor.bias_mps2 = {0.1, 0.2, -0.3};
  options.slide.any_mounting = true;
  options.slide.gravity_removed = true;
  const ProcedureResult result = simulated(options);
  const Triple acc(result.recording, "acc");
  EXPECT_LT((acc(10) - Eigen::Vector3d(0.1, 0.2, -0.3)).norm(), 1e-12);
  options.output = RigOutput::voltage;
  EXPECT_EQ(simulate_procedure(options).error().message, "gravity_removed needs an output in m/s²");
}

TEST(Slide, TheTrueSensorFileGivesTheTrueForceWhileItMoves) {
  ProcedureOptions options = noise_free(Procedure::slide);
  options.output = RigOutput::voltage;
  ProcedureResult result = simulated(options);
  ASSERT_TRUE(sensor::apply(result.truth.sensor, result.recording));
  const Triple acc(result.recording, "acc"), force(result.truth_series, "force");
  for (std::size_t k = 0; k < acc.x.size(); ++k) EXPECT_LT((acc(k) - force(k)).norm(), 1e-11);
}

TEST(Slide, AnotherSeedIsAnotherMountingAnotherSessionIsNot) {
  ProcedureOptions options = perfect();
  options.slide.any_mounting = true;
  const Eigen::Vector3d line = simulated(options).truth.line;
  options.session = 3;
  EXPECT_EQ(simulated(options).truth.line, line);
  options.seed = 2;
  EXPECT_GT((simulated(options).truth.line - line).norm(), 0.01);
}

TEST(Slide, AnyMountingIsEvenOverTheSphere) {
  ProcedureOptions options = perfect();
  options.slide = {.strokes = 1, .initial_rest_s = 0.1, .final_rest_s = 0.1, .any_mounting = true};
  options.rate_hz = 20.0;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (options.seed = 0; options.seed < 600; ++options.seed) {
    const Eigen::Vector3d line = simulated(options).truth.line;
    second += line * line.transpose() / 600.0;
  }
  EXPECT_LT((second - Eigen::Matrix3d::Identity() / 3.0).cwiseAbs().maxCoeff(), 0.05);
}

TEST(Slide, DescriptionReadsBack) {
  ProcedureOptions options = default_options(Procedure::slide);
  options.slide.repetitions = 8;
  options.slide.profile = SlideProfile::harmonic;
  options.slide.elevation_rad = 0.25;
  options.slide.gyro_bias_radps = {0.01, 0.02, 0.03};
  const std::string text = format_procedure_file(options);
  const auto read = parse_procedure_file(text, "slide.toml", Procedure::slide);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->slide.repetitions, 8);
  EXPECT_EQ(read->slide.profile, SlideProfile::harmonic);
  EXPECT_NEAR(read->slide.elevation_rad, 0.25, 1e-15);
  EXPECT_EQ(format_procedure_file(*read), text);
}

TEST(Slide, NamesTheOptionThatIsWrong) {
  const auto message = [](auto change) {
    ProcedureOptions options = default_options(Procedure::slide);
    change(options);
    const Status status = check(options);
    return status ? std::string() : status.error().message;
  };
  EXPECT_EQ(message([](auto&) {}), "");
  EXPECT_EQ(message([](auto& o) { o.slide.strokes = 0; }), "strokes must lie between 1 and 1000");
  EXPECT_EQ(message([](auto& o) { o.slide.length_m = NAN; }), "length_m must be a finite number");
  EXPECT_EQ(message([](auto& o) { o.slide.wobble_rms_rad = -1.0; }),
            "[slide] must not be negative");
  EXPECT_EQ(message([](auto& o) { o.slide.final_rest_s = 0.0; }),
            "initial_rest_s and final_rest_s must each hold at least two samples");
}

TEST(Slide, MeansOfItsRestsCanBeDrawn) {
  const PoseMeans means = draw_pose_means(default_options(Procedure::slide)).value();
  EXPECT_EQ(means.means.size(), 7U);
}

}  // namespace
}  // namespace proofmass::simulate::slide_test
