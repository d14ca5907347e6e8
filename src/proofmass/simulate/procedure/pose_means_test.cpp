#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/simulate/rig/bench_test_support.hpp"

namespace proofmass::simulate::pose_means_test {
namespace {

/// Means of the recording's own samples at rest.
std::vector<Eigen::Vector3d> means_of(const ProcedureResult& result) {
  std::vector<Eigen::Vector3d> sums(result.truth.poses.size(), Eigen::Vector3d::Zero());
  std::vector<double> counts(sums.size(), 0.0);
  const auto& position = column(result.truth_series, "position");
  const Triple acc(result.recording, "acc");
  for (std::size_t k = 0; k < position.size(); ++k) {
    if (position[k] == 0.0) continue;
    const std::size_t pose = static_cast<std::size_t>(position[k]) - 1;
    sums[pose] += acc(k);
    counts[pose] += 1.0;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
  return sums;
}

TEST(PoseMeans, WithoutNoiseAreThoseOfTheRecording) {
  for (const Procedure p : {Procedure::tumble, Procedure::six_position}) {
    ProcedureOptions options = noise_free(p);
    options.output = RigOutput::voltage;
    options.sensor.warm_up_mps2 = {0.1, 0.2, 0.3};
    options.sensor.ramp_mps2ps = {1e-4, -1e-4, 2e-4};
    const ProcedureResult result = simulated(options);
    const PoseMeans drawn = draw_pose_means(options).value();
    const auto expected = means_of(result);
    ASSERT_EQ(drawn.means.size(), expected.size());
    // A mean over samples is half a period early relative to one over time.
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_LT((drawn.means[k].mean - expected[k]).norm(), 2e-6) << k;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(drawn.truth.mean_drift_mps2[axis], result.truth.mean_drift_mps2[axis], 5e-5);
  }
}

TEST(PoseMeans, ScatterAsTheySay) {
  ProcedureOptions options = default_options(Procedure::six_position);
  options.sensor.flicker_mps2 = {};
  options.sensor.bias_walk_mps2_rts = {};
  options.output = RigOutput::voltage;
  Moments z;
  for (std::size_t trial = 0; trial < 500; ++trial) {
    const PoseMeans drawn = draw_pose_means(options, trial).value();
    for (const PoseMean& mean : drawn.means) {
      const std::size_t k = static_cast<std::size_t>(&mean - drawn.means.data());
      const Eigen::Vector3d off =
          mean.mean - expected(drawn.truth, drawn.truth.poses[k].force_mps2);
      for (Eigen::Index i = 0; i < 3; ++i) z.add(off(i) / mean.white_std(i));
    }
  }
  EXPECT_NEAR(z.mean, 0.0, 4.0 / std::sqrt(9000.0));
  EXPECT_NEAR(z.std(), 1.0, 4.0 / std::sqrt(18000.0));
}

// Compares the scatter of the sample means over the seeds with that of the drawn means.
TEST(PoseMeans, ScatterAsThoseOfRecordings) {
  ProcedureOptions options = default_options(Procedure::six_position);
  options.timing.dwell_s = 3.0;
  options.rate_hz = 20.0;
  options.timing.move_s = 0.5;
  options.sensor.flicker_mps2 = {0.02, 0.02, 0.02};
  options.sensor.bias_walk_mps2_rts = {0.01, 0.01, 0.01};
  double recorded = 0.0, drawn = 0.0;
  const auto squares = [](const std::vector<Eigen::Vector3d>& off) {
    double sum = 0.0;
    for (std::size_t k = 1; k < off.size(); ++k) sum += (off[k] - off[k - 1]).squaredNorm();
    return sum;
  };
  for (options.seed = 1; options.seed <= 60; ++options.seed) {
    const ProcedureResult result = simulated(options);
    const PoseMeans means = draw_pose_means(options, options.seed).value();
    std::vector<Eigen::Vector3d> a = means_of(result), b;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Eigen::Vector3d truth = expected(result.truth, result.truth.poses[k].force_mps2);
      a[k] -= truth;
      b.push_back(means.means[k].mean - truth);
    }
    recorded += squares(a);
    drawn += squares(b);
  }
  EXPECT_NEAR(recorded / drawn, 1.0, 0.2);
}

TEST(PoseMeans, AnotherTrialHasTheSameTruthAndOtherNoise) {
  const ProcedureOptions options;
  const PoseMeans a = draw_pose_means(options, 1).value(), b = draw_pose_means(options, 2).value();
  EXPECT_EQ(a.truth.equations, b.truth.equations);
  EXPECT_EQ(a.truth.poses[3].force_mps2, b.truth.poses[3].force_mps2);
  EXPECT_NE(a.means[3].mean, b.means[3].mean);
  EXPECT_EQ(draw_pose_means(options, 2).value().means[3].mean, b.means[3].mean);
}

TEST(PoseMeans, RefuseWhatTheProcedureRefuses) {
  ProcedureOptions options;
  options.hand.poses = 0;
  EXPECT_EQ(draw_pose_means(options).error().message, "poses must lie between 1 and 1000");
}

}  // namespace
}  // namespace proofmass::simulate::pose_means_test
