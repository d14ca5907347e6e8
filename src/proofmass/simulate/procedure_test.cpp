#include "proofmass/simulate/procedure.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "proofmass/sensor/calibration.hpp"
#include "proofmass/simulate/rig/bench_test_support.hpp"

namespace proofmass::simulate::procedure_test {
namespace {

constexpr double g = standard_gravity_mps2;
constexpr std::array all{Procedure::tumble, Procedure::four_position, Procedure::six_position,
                         Procedure::multi_position};

std::size_t middle(const TruePose& pose, const ProcedureOptions& options) {
  return static_cast<std::size_t>(0.5 * (pose.start_s + pose.end_s) * options.rate_hz);
}

TEST(Procedure, HasANameThatReadsBack) {
  for (const Procedure p : all) EXPECT_EQ(procedure_named(name_of(p)), p);
  EXPECT_FALSE(procedure_named("tumbling"));
}

TEST(Procedure, TheTrueSensorFileGivesTheTrueForce) {
  for (const Procedure p : all)
    for (const RigOutput output : {RigOutput::acceleration, RigOutput::voltage}) {
      ProcedureOptions options = noise_free(p);
      options.output = output;
      options.supply.actual_v = 3.0;
      options.sensor.full_scale_mps2 = 1e3;
      options.sensor.scale_per_v = {0.01, -0.02, 0.03};
      options.sensor.bias_per_v_mps2pv = {0.1, 0.2, -0.3};
      ProcedureResult result = simulated(options);
      ASSERT_TRUE(sensor::apply(result.truth.sensor, result.recording));
      const Triple acc(result.recording, "acc");
      for (const TruePose& pose : result.truth.poses) {
        const Eigen::Vector3d f = acc(middle(pose, options));
        EXPECT_LT((f - pose.force_mps2).norm(), 1e-11);
        EXPECT_NEAR(pose.force_mps2.norm(), g, 1e-12);
      }
    }
}

TEST(Procedure, TheTrueEquationsGiveTheRecordingInItsUnit) {
  for (const RigOutput output : {RigOutput::acceleration, RigOutput::voltage, RigOutput::counts}) {
    ProcedureOptions options = noise_free(Procedure::multi_position);
    options.output = output;
    options.supply.actual_v = 3.6;
    options.sensor.scale_per_v = {0.01, 0.02, 0.03};
    options.sensor.full_scale_mps2 = 1e3;
    options.daq = {.bits = 24, .min_v = 0.0, .max_v = 5.0};
    for (std::size_t axis = 0; axis < 3; ++axis)
      options.sensor.equation[axis] = {.K0 = 0.1,
                                       .K0_asym = 0.01,
                                       .K1_asym = 1e-3,
                                       .Koq = 1e-4,
                                       .K2 = 2e-4,
                                       .K3 = 1e-5,
                                       .delta_o = 3e-3,
                                       .delta_p = -4e-3,
                                       .Kip = 1e-4,
                                       .Kio = 2e-4,
                                       .Kpo = 3e-4,
                                       .Kpp = 4e-4,
                                       .Koo = 5e-4};
    const double lsb_v = 5.0 / std::ldexp(1.0, 24);
    const double step = output == RigOutput::acceleration ? lsb_v / 0.330 * g
                        : output == RigOutput::voltage    ? lsb_v
                                                          : 1.0;
    const ProcedureResult result = simulated(options);
    const Triple acc(result.recording, "acc");
    for (const TruePose& pose : result.truth.poses) {
      const Eigen::Vector3d off =
          acc(middle(pose, options)) - expected(result.truth, pose.force_mps2);
      EXPECT_LT(off.cwiseAbs().maxCoeff(), 0.5001 * step);
    }
  }
}

TEST(Procedure, AtRestNothingMovesAndBetweenItDoes) {
  for (const Procedure p : all) {
    const ProcedureOptions options = noise_free(p);
    const ProcedureResult result = simulated(options);
    const auto& position = column(result.truth_series, "position");
    const auto& rest = column(result.truth_series, "rest");
    const Triple true_force(result.truth_series, "force");
    double moved = 0.0;
    for (std::size_t k = 0; k < position.size(); ++k) {
      EXPECT_EQ(rest[k], position[k] > 0.0 ? 1.0 : 0.0);
      const Eigen::Vector3d force = true_force(k);
      if (rest[k] == 0.0) moved = std::max(moved, std::abs(force.norm() - g));
      if (rest[k] == 0.0) continue;
      const TruePose& pose = result.truth.poses[static_cast<std::size_t>(position[k]) - 1];
      ASSERT_EQ((force - pose.force_mps2).norm(), 0.0);
      const double t_s = static_cast<double>(k) / options.rate_hz;
      EXPECT_GE(t_s, pose.start_s);
      EXPECT_LT(t_s, pose.end_s);
    }
    EXPECT_GT(moved, 0.02);
  }
}

// At 10 kHz a step of force would be visible; the steepest feature, a shock of 12 ms, is not one.
TEST(Procedure, TheForceIsContinuous) {
  for (const Procedure p : {Procedure::tumble, Procedure::multi_position}) {
    ProcedureOptions options = noise_free(p);
    options.rate_hz = 10e3;
    options.table.positions = 2;
    options.table.remounted = true;
    options.table.remount_s = 2.0;
    options.hand.poses = 2;
    options.hand.initial_rest_s = 1.0;
    options.timing.dwell_s = 1.0;
    const ProcedureResult result = simulated(options);
    const Triple force(result.truth_series, "force");
    double steepest = 0.0;
    for (std::size_t k = 1; k < force.x.size(); ++k)
      steepest = std::max(steepest, (force(k) - force(k - 1)).norm());
    EXPECT_GT(steepest, 1e-4);
    EXPECT_LT(steepest, 0.3);
  }
}

TEST(Procedure, SameSeedSameNumbers) {
  ProcedureOptions options = default_options(Procedure::six_position);
  const ProcedureResult a = simulated(options), b = simulated(options);
  options.seed = 2;
  const ProcedureResult c = simulated(options);
  EXPECT_EQ(column(a.recording, "acc_x"), column(b.recording, "acc_x"));
  EXPECT_NE(column(a.recording, "acc_x"), column(c.recording, "acc_x"));
  EXPECT_NE(a.truth.equations[0], c.truth.equations[0]);
}

TEST(Procedure, AnotherSessionHasTheSameSensorAndAllElseAnew) {
  ProcedureOptions options = default_options(Procedure::six_position);
  const ProcedureResult a = simulated(options);
  options.session = 1;
  const ProcedureResult b = simulated(options);
  EXPECT_EQ(a.truth.equations, b.truth.equations);
  EXPECT_NE(a.truth.poses[2].force_mps2, b.truth.poses[2].force_mps2);
  EXPECT_NE(a.truth.poses[2].end_s, b.truth.poses[2].end_s);
}

TEST(Procedure, LabelsNameTheRests) {
  ProcedureOptions options = default_options(Procedure::six_position);
  EXPECT_TRUE(simulated(options).recording.labels.empty());
  options.labelled = true;
  const ProcedureResult result = simulated(options);
  ASSERT_EQ(result.recording.labels.size(), 6U);
  EXPECT_EQ(result.recording.labels[0].text, "x_up");
  EXPECT_EQ(result.recording.labels[3].text, "y_down");
  const auto& position = column(result.truth_series, "position");
  for (std::size_t k = 0; k < 6; ++k) {
    const Label& label = result.recording.labels[k];
    const auto number = static_cast<double>(k + 1);
    EXPECT_EQ(position[label.first], number);
    EXPECT_EQ(position[label.last], number);
    if (k > 0) {
      EXPECT_EQ(position[label.first - 1], 0.0);
    }
    if (k < 5) {
      EXPECT_EQ(position[label.last + 1], 0.0);
    }
  }
}

TEST(Procedure, MultiPositionRestsLongThenStandsInSpreadPositions) {
  const ProcedureOptions options = default_options(Procedure::multi_position);
  const ProcedureResult result = simulated(options);
  ASSERT_EQ(result.truth.poses.size(), 25U);
  EXPECT_EQ(result.truth.poses[0].end_s, 20.0);
  EXPECT_GT(result.truth.poses[0].force_mps2.z(), 0.95 * g);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::size_t k = 1; k < 25; ++k) {
    const TruePose& pose = result.truth.poses[k];
    squares += pose.force_mps2 * pose.force_mps2.transpose() / (24.0 * g * g);
    EXPECT_GT(pose.end_s - pose.start_s, 2.5);
    EXPECT_LT(pose.end_s - pose.start_s, 4.3);
  }
  EXPECT_LT((squares - Eigen::Matrix3d::Identity() / 3.0).cwiseAbs().maxCoeff(), 0.05);
}

TEST(Procedure, ABadPoseIsPushedByAsMuchAsAsked) {
  ProcedureOptions options = noise_free(Procedure::multi_position);
  options.hand.bad_pose = 7;
  options.hand.bad_pose_push_mps2 = 5e-3 * g;
  for (const TruePose& pose : simulated(options).truth.poses)
    EXPECT_NEAR(pose.force_mps2.norm() - g, pose.number == 7 ? 5e-3 * g : 0.0, 1e-12);
}

TEST(Procedure, ClippingStopsAtFullScale) {
  ProcedureOptions options = noise_free(Procedure::six_position);
  options.sensor.full_scale_mps2 = 9.0;
  const auto x = column(simulated(options).recording, "acc_x");
  EXPECT_NEAR(*std::ranges::max_element(x), 9.0, 1e-12);
}

TEST(Procedure, SaysWhichOptionMakesNoSense) {
  const auto message = [](auto change) {
    ProcedureOptions options;
    change(options);
    const auto result = simulate_procedure(options);
    EXPECT_EQ(result.has_value(), check(options).has_value());
    return result ? "no error" : result.error().message;
  };
  EXPECT_EQ(message([](auto& o) { o.rate_hz = NAN; }), "rate_hz must be a finite number");
  EXPECT_EQ(message([](auto& o) { o.timing.dwell_s = 0.5; }),
            "dwell_s less its jitter must be longer than settle_s");
  EXPECT_EQ(message([](auto& o) { o.rate_hz = 0.1; }),
            "dwell_s must leave at least two samples of rest in each position");
  EXPECT_EQ(message([](auto& o) { o.hand.bad_pose = 26; }),
            "bad_pose must be one of the positions");
  EXPECT_EQ(message([](auto& o) { o.output = RigOutput::counts; }),
            "output \"counts\" needs a converter; set daq.bits");
  EXPECT_EQ(message([](auto& o) { o.sensor.equation[1].K2 = INFINITY; }),
            "K2 must be finite numbers");
  EXPECT_EQ(message([](auto& o) { o.sensor.scale[2] = 0.0; }), "scale must be positive");
}

}  // namespace
}  // namespace proofmass::simulate::procedure_test
