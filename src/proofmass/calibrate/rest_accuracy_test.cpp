#include "proofmass/calibrate/rest_accuracy.hpp"

#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position_test_support.hpp"

namespace proofmass::calibrate::rest_accuracy_test {
namespace {

using test::g;
using test::mg;

MultiPosition calibrated(const test::PoseDraw& draw, double gravity_std_mps2, int seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  const Parameters truth = test::drawn_sensor(random);
  return calibrate_positions(test::drawn_poses(truth, draw, random),
                             {.gravity_mps2 = g,
                              .gravity_std_mps2 = gravity_std_mps2,
                              .noise_dof = draw.claimed_mps2 > 0.0 ? 1000.0 : 0.0})
      .value();
}

TEST(RestAccuracy, IsTheErrorOnNewDirections) {
  double stated = 0.0, found = 0.0;
  for (int seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Parameters truth = test::drawn_sensor(random);
    const test::PoseDraw draw{.count = 18};
    const MultiPosition fit = calibrate_positions(test::drawn_poses(truth, draw, random),
                                                  {.gravity_mps2 = g, .noise_dof = 1000.0})
                                  .value();
    const RestAccuracy accuracy = rest_accuracy(fit).value();
    const double scatter = accuracy.scatter_mps2;
    stated += accuracy.overall_mps2 * accuracy.overall_mps2 - scatter * scatter;
    found += std::pow(test::error_on_new_directions(fit, truth, random), 2);
  }
  EXPECT_NEAR(std::sqrt(found / stated), 1.0, 0.15);
}

TEST(RestAccuracy, HoldsGravityInAllDirectionsAlike) {
  const RestAccuracy without = rest_accuracy(calibrated({}, 0.0, 3)).value();
  const RestAccuracy with = rest_accuracy(calibrated({}, 0.015, 3)).value();
  EXPECT_NEAR(with.overall_mps2, std::hypot(without.overall_mps2, 0.015), 1e-9);
  EXPECT_NEAR(with.by_noise_mps2, without.overall_mps2, 1e-9);
  EXPECT_EQ(with.main_type_b, "gravity");
  EXPECT_EQ(without.main_type_b, "");
  EXPECT_NEAR(with.worst_mps2, std::hypot(without.worst_mps2, 0.015), 1e-9);
}

TEST(RestAccuracy, TakesTheScatterFromTheResidualsWhereNoiseDoesNotExplainThem) {
  const double small = 1e-5 * g;
  const RestAccuracy claimed = rest_accuracy(calibrated({.claimed_mps2 = small}, 0.0, 5)).value();
  const RestAccuracy unknown = rest_accuracy(calibrated({.claimed_mps2 = 0.0}, 0.0, 5)).value();
  EXPECT_NEAR(claimed.scatter_mps2, 0.1 * mg, 0.04 * mg);
  EXPECT_NEAR(unknown.scatter_mps2, claimed.scatter_mps2, 0.01 * mg);
  EXPECT_NEAR(rest_accuracy(calibrated({}, 0.0, 5))->scatter_mps2, 0.1 * mg, 1e-3 * mg);
}

TEST(RestAccuracy, IsUnknownWhereTheNoiseIs) {
  EXPECT_FALSE(rest_accuracy(calibrated({.count = 9, .claimed_mps2 = 0.0}, 0.01, 2)));
}

TEST(RestAccuracy, NamesTheDirectionThatWasLeftOut) {
  std::mt19937_64 random(4);
  const Parameters truth = test::drawn_sensor(random);
  std::vector<Pose> poses = test::drawn_poses(truth, {.count = 60}, random);
  std::erase_if(poses, [](const Pose& pose) { return pose.up->z() < -0.2; });
  const RestAccuracy accuracy =
      rest_accuracy(calibrate_positions(poses, {.gravity_mps2 = g, .noise_dof = 1000.0}).value())
          .value();
  EXPECT_LT(accuracy.worst_up.z(), -0.8);
  EXPECT_GT(accuracy.worst_mps2, 1.5 * accuracy.overall_mps2);
}

}  // namespace
}  // namespace proofmass::calibrate::rest_accuracy_test
