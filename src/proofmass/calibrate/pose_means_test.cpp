#include "proofmass/calibrate/pose_means.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <span>
#include <vector>

#include "proofmass/calibrate/multi_position/dwell_noise.hpp"

namespace proofmass::calibrate::pose_means_test {
namespace {

constexpr std::size_t dwell = 400;

std::vector<double> white(std::size_t count, double std, unsigned seed, double offset = 33000.0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(offset, std);
  std::vector<double> out(count);
  for (double& value : out) value = normal(random);
  return out;
}

std::vector<Dwell> rests(std::size_t count) {
  std::vector<Dwell> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back({k * dwell, (k + 1) * dwell - 1});
  return out;
}

TEST(PoseMeans, OfWhiteNoiseAreKnownToSigmaOverRootN) {
  const auto x = white(40 * dwell, 3.0, 1), y = white(40 * dwell, 1.0, 2),
             z = white(40 * dwell, 2.0, 3);
  const PoseMeans means = pose_means({x, y, z}, rests(40)).value();
  ASSERT_EQ(means.poses.size(), 40U);
  for (const Pose& pose : means.poses) {
    EXPECT_NEAR(std::sqrt(pose.mean_covariance(0, 0)), 3.0 / std::sqrt(400.0), 0.015);
    EXPECT_NEAR(std::sqrt(pose.mean_covariance(1, 1)), 1.0 / std::sqrt(400.0), 0.005);
    EXPECT_EQ(pose.mean_covariance(0, 1), 0.0);
    EXPECT_NEAR(pose.mean.x(), 33000.0, 0.7);
    EXPECT_EQ(pose.samples, dwell);
  }
  EXPECT_NEAR(means.sample_std[0], 3.0, 0.1);
  EXPECT_GT(means.noise_dof, 5.0);
}

TEST(PoseMeans, OfSlowNoiseAreKnownToItsAllanDeviationAtTheDwell) {
  // For a random walk with steps of variance q, the Allan variance over m steps is q (2 m² + 1) / 6
  // m.
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  constexpr std::size_t count = 60;
  std::vector<double> walk(count * dwell);
  double level = 0.0;
  for (double& value : walk) value = level += 0.1 * normal(random);
  const PoseMeans means = pose_means({walk, walk, walk}, rests(count)).value();
  const double expected = 0.01 * 400.0 / 3.0;
  EXPECT_NEAR(means.poses[0].mean_covariance(0, 0) / expected, 1.0, 0.35);
}

TEST(PoseMeans, IgnoreSpikesAndNonFiniteValues) {
  auto x = white(2 * dwell, 1.0, 5), y = x, z = x;
  const double clean = pose_means({x, y, z}, rests(2)).value().poses[0].mean.x();
  x[10] = NAN;
  x[20] = INFINITY;
  x[30] = 3e34;
  x[40] = -1e300;
  const PoseMeans means = pose_means({x, y, z}, rests(2)).value();
  EXPECT_EQ(means.rejected, 4U);
  EXPECT_NEAR(means.poses[0].mean.x(), clean, 0.02);
  EXPECT_EQ(means.poses[0].samples, dwell - 4);
}

TEST(PoseMeans, KnowNoNoiseWhereThereIsNone) {
  const std::vector<double> still(2 * dwell, 5.0);
  const PoseMeans means = pose_means({still, still, still}, rests(2)).value();
  EXPECT_EQ(means.noise_dof, 0.0);
  EXPECT_EQ(means.poses[0].mean_covariance(0, 0), 0.0);
  // With a quantiser the mean may be anywhere within one step.
  const PoseMeans stepped = pose_means({still, still, still}, rests(2), {0.6, 0.6, 0.6}).value();
  EXPECT_NEAR(stepped.poses[0].mean_covariance(0, 0), 0.03, 1e-12);
  EXPECT_GT(stepped.noise_dof, 0.0);
}

TEST(PoseMeans, NameTheRestWithoutNumbers) {
  auto x = white(2 * dwell, 1.0, 6);
  const auto y = x, z = x;
  std::fill(x.begin() + dwell, x.end(), NAN);
  const auto means = pose_means({x, y, z}, rests(2));
  ASSERT_FALSE(means);
  EXPECT_NE(means.error().message.find("rest 2"), std::string::npos);
  EXPECT_EQ(pose_means({y, y, View<double>(z).first(3)}, {}).error().code, Errc::invalid_argument);
}

TEST(DwellNoise, IsTheSumOfItsParts) {
  const DwellNoise noise{
      .white = 4.0, .flicker = 0.5, .random_walk = 0.01, .dof = 1.0, .rounding = 0.2};
  EXPECT_DOUBLE_EQ(noise.variance_of_mean(10), 0.4 + 0.5 + 0.1 + 0.2);
}

DwellNoise noise_of(const std::vector<double>& samples, std::size_t each, double lsb = 0.0) {
  std::vector<std::span<const double>> rests;
  for (std::size_t k = 0; k + each <= samples.size(); k += each)
    rests.emplace_back(samples.data() + k, each);
  return fit_dwell_noise(rests, lsb);
}

// Markov processes of equal strength, spaced by an octave: a flat Allan deviation.
TEST(DwellNoise, OfFlickerDoesNotAverageOut) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  constexpr int octaves = 16;
  std::vector<double> samples(60 * dwell), state(octaves);
  for (double& value : state) value = normal(random);
  for (double& sample : samples) {
    sample = 0.0;
    for (int k = 0; k < octaves; ++k) {
      const double phi = std::exp(-std::exp2(1 - k));
      double& x = state[static_cast<std::size_t>(k)];
      sample += x = phi * x + std::sqrt(1.0 - phi * phi) * normal(random);
    }
  }
  const DwellNoise noise = noise_of(samples, dwell);
  // Octaves of unit variance give the two-sided density 1/(2 ln 2 f), whose Allan variance is 2.
  EXPECT_NEAR(noise.flicker, 2.0, 0.7);
  EXPECT_NEAR(noise.variance_of_mean(dwell), 2.0, 0.7);
  EXPECT_LT(noise.random_walk * dwell, 1.0);
}

// The variance of ln v over recordings of one sensor is 2/dof or less, since the choice between
// terms makes dof cautious.
TEST(DwellNoise, StatesItsOwnDegreesOfFreedom) {
  constexpr int recordings = 200;
  double sum = 0.0, squares = 0.0, claimed = 0.0;
  for (unsigned seed = 100; seed < 100 + recordings; ++seed) {
    const DwellNoise noise = noise_of(white(8 * 128, 1.0, seed, 0.0), 128);
    const double value = std::log(noise.variance_of_mean(128));
    sum += value / recordings;
    squares += value * value / recordings;
    claimed += 2.0 / noise.dof / recordings;
  }
  const double spread = squares - sum * sum;
  EXPECT_GT(claimed / spread, 0.9);
  EXPECT_LT(claimed / spread, 3.5);
}

// Rests at arbitrary levels between two quantisation steps: error of their means in addition to the
// noise that averages out.
TEST(DwellNoise, CountsWhatTheNoiseDoesNotAverageOutOfSteps) {
  constexpr std::size_t rests = 1000, each = 400;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> between;
  for (const double std : {0.0, 0.1, 0.2, 0.3, 1.0}) {
    std::vector<double> samples;
    double squares = 0.0;
    for (std::size_t k = 0; k < rests; ++k) {
      const double level = between(random);
      double sum = 0.0, noise_sum = 0.0;
      for (std::size_t i = 0; i < each; ++i) {
        const double noise = std * normal(random);
        samples.push_back(std::round(level + noise));
        sum += samples.back() - level;
        noise_sum += noise;
      }
      squares += sum * sum - noise_sum * noise_sum;
    }
    const double left = squares / (rests * each * each);
    const double rounding = noise_of(samples, each, 1.0).rounding;
    if (std == 1.0) {
      EXPECT_LT(rounding, 1e-12);
      continue;
    }
    EXPECT_NEAR(rounding / left, 1.0, 0.25) << std;
  }
}

TEST(DwellNoise, CountsAWholeStepOfSamplesThatNeverChange) {
  EXPECT_NEAR(noise_of(std::vector<double>(4 * dwell, 7.0), dwell, 1.0).rounding, 1.0 / 12.0,
              1e-15);
}

}  // namespace
}  // namespace proofmass::calibrate::pose_means_test
