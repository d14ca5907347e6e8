#include "proofmass/signal/encoder.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace proofmass::signal::encoder_test {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> times(std::size_t count, double rate_hz) {
  std::vector<double> out(count);
  for (std::size_t k = 0; k < count; ++k) out[k] = static_cast<double>(k) / rate_hz;
  return out;
}

TEST(UnwrapAngle, FollowsACountThatWrapsInEitherDirection) {
  const std::vector<double> up{65530.0, 65534.0, 2.0, 6.0}, down{3.0, 65535.0, 65531.0};
  EXPECT_NEAR(unwrap_angle(up, 65536.0, 0.001).angle_rad[3], 65.542, 1e-12);
  EXPECT_NEAR(unwrap_angle(down, 65536.0, 1.0).angle_rad[2], -5.0, 1e-12);
}

TEST(UnwrapAngle, ASingleValueThatBothNeighboursContradictIsAGlitch) {
  const std::vector<double> counts{10.0, 11.0, 12.0, 900.0, 14.0, 15.0, 45.0, 46.0};
  const UnwrappedAngle found = unwrap_angle(counts, 0.0, 1.0);
  EXPECT_EQ(found.glitches, 1U);
  EXPECT_TRUE(std::isnan(found.angle_rad[3]));
  EXPECT_EQ(found.angle_rad[6], 45.0);  // a lasting change is none
}

TEST(AngleFixes, OfASlowWheelAreTheBoundariesOfTheCounts) {
  // 0.3 counts a sample: the boundaries are crossed at a known angle, at an unknown moment.
  const std::vector<double> t = times(200, 100.0);
  std::vector<double> angle;
  for (const double time : t) angle.push_back(0.01 * std::floor(0.3 * 100.0 * time + 0.55));
  const AngleFixes fixes = fixes_of_samples(t, angle, 0.01, 0.0);
  ASSERT_GT(fixes.time_s.size(), 50U);
  for (std::size_t i = 2; i < fixes.time_s.size(); ++i) {
    const double truth = 0.01 * (0.3 * 100.0 * fixes.time_s[i] + 0.55);
    EXPECT_NEAR(fixes.angle_rad[i], truth, 0.0016) << i;  // half a sample's motion
    EXPECT_LT(fixes.std_rad[i], 0.0016);
  }
}

TEST(AngleFixes, OfAFastWheelAreTheMiddlesOfTheCounts) {
  const std::vector<double> t = times(50, 100.0);
  std::vector<double> angle;
  for (const double time : t) angle.push_back(0.01 * std::floor(570.0 * time));
  const AngleFixes fixes = fixes_of_samples(t, angle, 0.01, 0.0);
  EXPECT_NEAR(fixes.angle_rad[20], 5.7 * fixes.time_s[20], 0.0051);
  EXPECT_NEAR(fixes.std_rad[20], 0.01 / std::sqrt(12.0), 1e-12);
}

TEST(AngleFixes, AWheelAtRestIsNotMeasuredAnewWithEverySample) {
  const std::vector<double> t = times(1000, 100.0);
  const AngleFixes fixes = fixes_of_samples(t, std::vector<double>(1000, 0.5), 0.01, 0.0);
  EXPECT_LE(fixes.time_s.size(), 21U);
}

TEST(AngleFixes, AnEdgeIsTheBoundaryThatItCrosses) {
  // Forwards to count 5: the boundary of 4 and 5. Back to 4: the same one.
  const std::vector<double> t{0.0, 1.0, 2.0}, angle{4.0, 5.0, 4.0};
  const AngleFixes fixes = fixes_of_edges(t, angle, 1.0, 1e-6);
  ASSERT_EQ(fixes.time_s.size(), 2U);
  EXPECT_EQ(fixes.angle_rad[0], 5.0);
  EXPECT_EQ(fixes.angle_rad[1], 5.0);
}

TEST(MotionAt, IsExactForUniformAcceleration) {
  AngleFixes fixes;
  for (const double t : times(2000, 200.0)) {
    fixes.time_s.push_back(t);
    fixes.angle_rad.push_back(0.3 + 1.2 * t + 0.15 * t * t);
    fixes.std_rad.push_back(1e-3);
  }
  const std::vector<double> at{1.0, 3.33, 7.0};
  const AngleMotion motion = motion_at(fixes, at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_NEAR(motion.speed_radps[k], 1.2 + 0.3 * at[k], 1e-4);
    EXPECT_NEAR(motion.accel_radps2[k], 0.3, 2e-3);
    EXPECT_NEAR(motion.angle_rad[k], 0.3 + 1.2 * at[k] + 0.15 * at[k] * at[k], 2e-5);
  }
}

TEST(MotionAt, KeepsARippleTwiceATurn) {
  AngleFixes fixes;
  for (const double t : times(4000, 200.0)) {
    fixes.time_s.push_back(t);
    fixes.angle_rad.push_back(1.2 * t + 0.01 * std::sin(2.4 * t));
    fixes.std_rad.push_back(1e-4);
  }
  const std::vector<double> at = times(150, 10.0);
  const AngleMotion motion = motion_at(fixes, at);
  for (std::size_t k = 20; k < at.size(); ++k) {
    EXPECT_NEAR(motion.angle_rad[k], 1.2 * at[k] + 0.01 * std::sin(2.4 * at[k]), 2e-5) << k;
    EXPECT_NEAR(motion.speed_radps[k] - 1.2, 0.024 * std::cos(2.4 * at[k]), 0.004 * 0.024) << k;
    EXPECT_NEAR(motion.accel_radps2[k], -0.0576 * std::sin(2.4 * at[k]), 0.004 * 0.0576) << k;
  }
}

struct Offsets {
  std::vector<double> time_s = times(800, 4.0), offset_rad;
};

Offsets drawn(std::uint64_t seed, double std_rad) {
  Offsets out;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, std_rad);
  for (std::size_t k = 0; k < out.time_s.size(); ++k) out.offset_rad.push_back(normal(random));
  return out;
}

TEST(CountSlips, AreFoundWithTheirTimeAndSize) {
  Offsets data = drawn(1, 1e-3);
  for (std::size_t k = 0; k < 800; ++k) {
    if (data.time_s[k] > 60.1) data.offset_rad[k] -= 3 * 1.5e-3;
    if (data.time_s[k] > 120.1) data.offset_rad[k] += 1.5e-3;
  }
  const auto found = find_count_slips(data.time_s, data.offset_rad, 1.5e-3);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].counts, -3);
  EXPECT_EQ(found[1].counts, 1);
  EXPECT_LE(found[0].start_s, 60.1);
  EXPECT_GE(found[0].end_s, 60.1);
  EXPECT_LE(found[1].start_s, 120.1);
  EXPECT_GE(found[1].end_s, 120.1);
}

TEST(CountSlips, AreNotFoundInNoise) {
  std::size_t recordings = 0;
  for (std::uint64_t seed = 10; seed < 210; ++seed) {
    const Offsets data = drawn(seed, 1e-3);
    recordings += find_count_slips(data.time_s, data.offset_rad, 1e-3).empty() ? 0 : 1;
  }
  EXPECT_LE(recordings, 2U);
}

TEST(CountSlips, AStepThatIsNoWholeNumberOfCountsIsNone) {
  Offsets data = drawn(3, 1e-3);
  for (std::size_t k = 400; k < 800; ++k) data.offset_rad[k] += 1.5 * 1e-2;
  EXPECT_TRUE(find_count_slips(data.time_s, data.offset_rad, 1e-2).empty());
}

TEST(CountSlips, TheSmallestThatIsFoundFollowsTheNoise) {
  EXPECT_EQ(detectable_counts(drawn(5, 1e-3).offset_rad, 1e-2), 1);
  const int coarse = detectable_counts(drawn(5, 1e-2).offset_rad, 1e-3).value();
  EXPECT_GE(coarse, 4);
  EXPECT_LE(coarse, 12);
  EXPECT_FALSE(detectable_counts(drawn(5, 1e-3).offset_rad, 0.0));
}

}  // namespace
}  // namespace proofmass::signal::encoder_test
