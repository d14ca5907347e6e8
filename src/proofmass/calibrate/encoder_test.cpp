#include "proofmass/calibrate/encoder.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/encoder_test_support.hpp"

namespace proofmass::calibrate::encoder_test {
namespace {

using test::SimulatedEncoder;

// Without noise and quantisation worth mentioning.
SimulatedEncoder ideal() {
  SimulatedEncoder wheel;
  wheel.seconds = 60.0;
  wheel.counts_per_turn = 1 << 18;
  wheel.noise_mps2 = 1e-5;
  wheel.slow_mps2 = 0.0;
  wheel.lsb_mps2 = 1e-7;
  return wheel;
}

EncoderCalibration calibrated(const SimulatedEncoder& wheel, const EncoderOptions& options = {}) {
  std::mt19937_64 random(1);
  return calibrate_encoder(test::simulate(wheel, random), options).value();
}

void expect_errors(const EncoderCalibration& fit,
                   const SimulatedEncoder& wheel,
                   double within_rad) {
  const test::EncoderTruth truth = test::truth_of(wheel);
  for (std::size_t order = 0; order < 2; ++order) {
    EXPECT_NEAR(fit.harmonics[order].cos_rad.value, truth.errors[2 * order], within_rad);
    EXPECT_NEAR(fit.harmonics[order].sin_rad.value, truth.errors[2 * order + 1], within_rad);
  }
}

TEST(Encoder, FindsEccentricityBesideBiasScaleSkewAndLeverArm) {
  const SimulatedEncoder wheel = ideal();
  const EncoderCalibration fit = calibrated(wheel, {.nonlinearity = 1e-7, .runout_m = 1e-9});
  expect_errors(fit, wheel, 2e-5);
  EXPECT_TRUE(fit.converged);
  EXPECT_TRUE(fit.missed.empty());
  ASSERT_TRUE(fit.harmonics[0].amplitude_rad);
  EXPECT_NEAR(fit.harmonics[0].amplitude_rad->value, 0.005, 2e-5);
  EXPECT_NEAR(fit.harmonics[0].phase_rad->value, 0.4 - 0.5 * std::numbers::pi, 0.003);
}

TEST(Encoder, TakesARippleOfTheSpeedForNoError) {
  SimulatedEncoder wheel = ideal();
  wheel.ripples = {{1, 0.03, 0.5}, {2, 0.02, 1.5}};
  const EncoderCalibration fit = calibrated(wheel, {.nonlinearity = 1e-7, .runout_m = 1e-9});
  // The delay of the accelerometers, 3.2 ms here, moves the ripple by 0.1 mrad.
  expect_errors(fit, wheel, 2e-4);
  EXPECT_LT(std::abs(fit.harmonics[0].sin_rad.value - test::truth_of(wheel).errors[1]),
            2.0 * fit.harmonics[0].sin_rad.std);
}

TEST(Encoder, OneAxisIsEnough) {
  const SimulatedEncoder wheel = ideal();
  std::mt19937_64 random(1);
  EncoderRecording recording = test::simulate(wheel, random);
  recording.axes.resize(1);
  recording.axis_names.resize(1);
  recording.sensor_of.resize(1);
  const auto fit = calibrate_encoder(recording, {.nonlinearity = 1e-7, .runout_m = 1e-9});
  ASSERT_TRUE(fit) << fit.error().message;
  expect_errors(*fit, wheel, 5e-5);
}

TEST(Encoder, StampedEdgesServeLikeCounts) {
  SimulatedEncoder wheel = ideal();
  wheel.counts_per_turn = 360;
  wheel.edges = true;
  expect_errors(calibrated(wheel, {.nonlinearity = 1e-7, .runout_m = 1e-9}), wheel, 5e-5);
}

TEST(Encoder, NamesMissedCountsWithTheirTime) {
  SimulatedEncoder wheel;
  wheel.missed = {{40.0, 1.0}, {80.0, -3.0}};
  const EncoderCalibration fit = calibrated(wheel);
  ASSERT_EQ(fit.missed.size(), 2U);
  EXPECT_EQ(fit.missed[0].counts, -1);
  EXPECT_EQ(fit.missed[1].counts, 3);
  for (const auto& [slip, truth_s] : {std::pair{fit.missed[0], 40.0}, {fit.missed[1], 80.0}}) {
    // A sixteenth of a turn takes 0.34 s.
    EXPECT_NEAR(slip.time_s, truth_s, 0.4);
    EXPECT_LE(slip.start_s, truth_s);
    EXPECT_GE(slip.end_s, truth_s);
  }
  expect_errors(fit, wheel, 1e-3);
}

// Beside the centripetal force of the lever arm a nonlinearity changes the response to gravity with
// the speed, as an error once a turn does: it was up to 15 standard deviations off.
TEST(Encoder, ANonlinearityAtTwoSpeedsIsNotTakenForAnErrorOnceATurn) {
  SimulatedEncoder wheel;
  wheel.speed_radps = [](double t) { return 2.0 + 2.5 / (1.0 + std::exp(60.0 - t)); };
  wheel.sensors = {{0.15, 0.0, 0.3}};
  wheel.noise_mps2 = 0.005;
  wheel.square_std = 2e-4;
  const test::EncoderTruth truth = test::truth_of(wheel);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937_64 random(seed);
    const EncoderCalibration fit = calibrate_encoder(test::simulate(wheel, random), {}).value();
    const EncoderHarmonic& once = fit.harmonics[0];
    EXPECT_NEAR(once.cos_rad.value, truth.errors[0], 3.5 * once.cos_rad.std) << seed;
    EXPECT_NEAR(once.sin_rad.value, truth.errors[1], 3.5 * once.sin_rad.std) << seed;
    EXPECT_LT(once.cos_rad.std, 2e-4) << seed;
  }
}

// The noise of the angular acceleration that the encoder shows, times the lever arm, is several
// times the accelerometers' own. In the residuals as well as in their derivatives it biased delay,
// lever arm and harmonics by up to 28 standard deviations.
TEST(Encoder, TheNoiseOfItsAccelerationBiasesNothing) {
  SimulatedEncoder wheel;
  wheel.rate_hz = 100.0;
  wheel.seconds = 80.0;
  wheel.speed_radps = [](double t) { return 5.0 + 5.4 / (1.0 + std::exp(2.0 * (40.0 - t))); };
  wheel.ripples = {{1, 0.004, 0.5}, {2, 0.006, 2.0}};
  wheel.sensors = {{0.17, 0.1, 0.3}};
  wheel.counts_per_turn = 1024;
  const test::EncoderTruth truth = test::truth_of(wheel);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937_64 random(seed);
    const EncoderCalibration fit = calibrate_encoder(test::simulate(wheel, random), {}).value();
    EXPECT_TRUE(fit.converged);
    for (std::size_t order = 0; order < 2; ++order) {
      const EncoderHarmonic& one = fit.harmonics[order];
      EXPECT_NEAR(one.cos_rad.value, truth.errors[2 * order], 3.5 * one.cos_rad.std) << seed;
      EXPECT_NEAR(one.sin_rad.value, truth.errors[2 * order + 1], 3.5 * one.sin_rad.std) << seed;
      EXPECT_LT(one.cos_rad.std, 1e-3) << seed;
    }
  }
}

TEST(Encoder, AStopIsNoMissedCount) {
  SimulatedEncoder wheel;
  wheel.speed_radps = [](double t) {
    return 5.0 * (1.0 - 1.0 / (1.0 + std::exp(4.0 * (50.0 - t))) +
                  1.0 / (1.0 + std::exp(4.0 * (60.0 - t))));
  };
  wheel.ripples = {{1, 0.004, 0.5}, {2, 0.006, 2.0}};
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    const EncoderCalibration fit = calibrate_encoder(test::simulate(wheel, random), {}).value();
    EXPECT_TRUE(fit.missed.empty()) << seed;
  }
}

TEST(Encoder, TheNonlinearityOfTheAccelerometersIsInTheInterval) {
  const double small = calibrated(ideal(), {.nonlinearity = 1e-5}).harmonics[0].cos_rad.std;
  const double large = calibrated(ideal(), {.nonlinearity = 1e-3}).harmonics[0].cos_rad.std;
  // Two axes show the second order as p/2: √2 · 1e-3/2.
  EXPECT_NEAR(large, 0.71e-3, 0.15e-3);
  EXPECT_LT(small, 0.05 * large);
}

TEST(Encoder, HarmonicsBeyondTheAssumedNonlinearityWidenTheInterval) {
  SimulatedEncoder wheel = ideal();
  wheel.square_std = 5e-3;
  const EncoderCalibration fit = calibrated(wheel);
  EXPECT_GT(fit.nonlinearity, 1e-3);
  EXPECT_GT(fit.harmonics[0].cos_rad.std, 5e-4);
}

TEST(Encoder, WithoutErrorGivesAnUpperBoundAndNoAmplitude) {
  SimulatedEncoder wheel;
  wheel.eccentricity = wheel.warp_rad = 0.0;
  const EncoderCalibration fit = calibrated(wheel);
  EXPECT_FALSE(fit.harmonics[0].amplitude_rad);
  EXPECT_FALSE(fit.harmonics[0].phase_rad);
  EXPECT_EQ(fit.harmonics[0].amplitude_95_rad[0], 0.0);
  EXPECT_LT(fit.harmonics[0].amplitude_95_rad[1], 1.5e-3);
}

TEST(Encoder, SaysWhyItCannot) {
  std::mt19937_64 random(1);
  SimulatedEncoder wheel;
  wheel.seconds = 10.0;
  EXPECT_EQ(calibrate_encoder(test::simulate(wheel, random)).error().code, Errc::too_few_samples);
  wheel.seconds = 60.0;
  EncoderRecording recording = test::simulate(wheel, random);
  for (double& angle : recording.encoder.angle_rad) angle *= 1.37;  // another --counts-per-turn
  EXPECT_EQ(calibrate_encoder(recording).error().code, Errc::not_observable);
  wheel.counts_per_turn = 24;
  EXPECT_EQ(calibrate_encoder(test::simulate(wheel, random)).error().code, Errc::too_few_samples);
  EXPECT_EQ(calibrate_encoder({}).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::calibrate::encoder_test
