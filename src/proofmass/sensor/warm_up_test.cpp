#include "proofmass/sensor/warm_up.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace proofmass::sensor::warm_up_test {
namespace {

/// Table 4.1 of the thesis, with standard deviations of our own.
WarmUp thesis_warm_up() {
  WarmUp warm_up{.a1_mps2 = 0.25, .a2_mps2 = -0.21, .time_constant_s = 70.0};
  warm_up.covariance = {{{4e-4, 0.0, 0.0}, {0.0, 1e-4, 0.0}, {0.0, 0.0, 25.0}}};
  return warm_up;
}

DriftModel drift_of_x() {
  DriftModel drift;
  drift.a1[0] = make_figure(25.0, "mg", "fit");
  drift.a1[0]->std = 2.0;
  drift.a2[0] = make_figure(-0.21, "m/s^2", "fit");
  drift.time_constant[0] = make_figure(70.0, "s", "fit");
  drift.time_constant[0]->std = 5.0;
  return drift;
}

Recording three_axes(std::size_t samples) {
  Recording recording;
  recording.time.source = TimeSource::given_rate;
  recording.time.rate_hz = 10.0;
  for (const char* name : {"acc_x", "acc_y", "acc_z"})
    recording.channels.push_back({name, *parse_unit("m/s^2"), std::vector<double>(samples, 1.0)});
  return recording;
}

TEST(WarmUp, IsReadFromADriftModelInSi) {
  const WarmUp warm_up = warm_up_of(drift_of_x(), 0).value();
  EXPECT_DOUBLE_EQ(warm_up.a1_mps2, 0.025 * standard_gravity_mps2);
  EXPECT_EQ(warm_up.a2_mps2, -0.21);
  EXPECT_EQ(warm_up.time_constant_s, 70.0);
  EXPECT_DOUBLE_EQ(warm_up.covariance[0][0], std::pow(0.002 * standard_gravity_mps2, 2));
  EXPECT_EQ(warm_up.covariance[1][1], 0.0);
  EXPECT_EQ(warm_up.covariance[2][2], 25.0);
  EXPECT_EQ(warm_up.covariance[0][2], 0.0);
}

TEST(WarmUp, SaysWhichFigureIsMissing) {
  const auto refused = [](auto spoil, std::size_t axis = 0) {
    DriftModel drift = drift_of_x();
    spoil(drift);
    const auto warm_up = warm_up_of(drift, axis);
    return warm_up ? std::string("no error") : warm_up.error().message;
  };
  const auto nothing = [](DriftModel&) {};
  EXPECT_EQ(refused(nothing), "no error");
  EXPECT_EQ(refused(nothing, 1), "drift.a1 of axis y: is missing");
  EXPECT_EQ(refused([](DriftModel& d) { d.a2[0].reset(); }), "drift.a2 of axis x: is missing");
  EXPECT_EQ(refused([](DriftModel& d) { d.time_constant[0].reset(); }),
            "drift.T of axis x: is missing");
  EXPECT_EQ(refused([](DriftModel& d) { d.time_constant[0]->value = 0.0; }),
            "drift.T of axis x: must be positive");
}

TEST(WarmUp, RisesFromA2ByA1) {
  const WarmUp warm_up = thesis_warm_up();
  EXPECT_EQ(bias_at(warm_up, 0.0).value, -0.21);
  EXPECT_NEAR(bias_at(warm_up, 70.0).value, -0.21 + 0.25 * (1.0 - 1.0 / std::exp(1.0)), 1e-16);
  EXPECT_NEAR(bias_at(warm_up, 1e5).value, 0.04, 1e-16);
  EXPECT_NEAR(warm_up.settled_mps2(), 0.04, 1e-16);
}

TEST(WarmUp, HasTheStandardDeviationOfItsPartialDerivatives) {
  const WarmUp warm_up = thesis_warm_up();
  for (const double t : {0.0, 3.0, 70.0, 400.0}) {
    const auto by = [&](auto member, double h) {
      WarmUp more = warm_up, less = warm_up;
      more.*member += h;
      less.*member -= h;
      return (bias_at(more, t).value - bias_at(less, t).value) / (2.0 * h);
    };
    const double expected =
        std::hypot(by(&WarmUp::a1_mps2, 1e-3) * 0.02, by(&WarmUp::a2_mps2, 1e-3) * 0.01,
                   by(&WarmUp::time_constant_s, 1e-3) * 5.0);
    EXPECT_NEAR(bias_at(warm_up, t).std, expected, 1e-10) << "t = " << t;
  }
}

TEST(WarmUp, TakesCorrelationsIntoItsStandardDeviation) {
  WarmUp warm_up = thesis_warm_up();
  warm_up.covariance = {{{4e-4, -2e-4, 0.0}, {-2e-4, 1e-4, 0.0}, {0.0, 0.0, 0.0}}};
  // Fully anticorrelated: σ(b) = |0.02 (1 − φ) − 0.01|, which vanishes after T ln 2.
  EXPECT_NEAR(bias_at(warm_up, 0.0).std, 0.01, 1e-15);
  EXPECT_NEAR(bias_at(warm_up, 70.0 * std::log(2.0)).std, 0.0, 1e-9);
  EXPECT_NEAR(bias_at(warm_up, 1e5).std, 0.01, 1e-15);
}

TEST(WarmUp, HasTheMeanOfManyValues) {
  const WarmUp warm_up = thesis_warm_up();
  constexpr int n = 2000;
  const OnTime stretch{15.0, 135.0};
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += bias_at(warm_up, 15.0 + 120.0 * (k + 0.5) / n).value;
  EXPECT_NEAR(mean_bias(warm_up, stretch).value, sum / n, 1e-8);
}

TEST(WarmUp, HasTheStandardDeviationOfItsMeanByDifferences) {
  const WarmUp warm_up = thesis_warm_up();
  const OnTime stretch{15.0, 135.0};
  const auto by = [&](auto member) {
    WarmUp more = warm_up, less = warm_up;
    more.*member += 1e-3;
    less.*member -= 1e-3;
    return (mean_bias(more, stretch).value - mean_bias(less, stretch).value) / 2e-3;
  };
  EXPECT_NEAR(mean_bias(warm_up, stretch).std,
              std::hypot(by(&WarmUp::a1_mps2) * 0.02, 0.01, by(&WarmUp::time_constant_s) * 5.0),
              1e-10);
}

TEST(WarmUp, ItsMeanOverNoTimeIsItsValue) {
  const WarmUp warm_up = thesis_warm_up();
  for (const double length_s : {0.0, 1e-9, 1e-5}) {
    const Uncertain mean = mean_bias(warm_up, {20.0, 20.0 + length_s});
    const Uncertain value = bias_at(warm_up, 20.0 + 0.5 * length_s);
    EXPECT_NEAR(mean.value, value.value, 1e-14) << length_s;
    EXPECT_NEAR(mean.std, value.std, 1e-7) << length_s;
  }
}

TEST(WarmUp, StepsFollowItExactlyWhateverTheirLength) {
  const WarmUp warm_up = thesis_warm_up();
  double bias_mps2 = warm_up.a2_mps2, t_s = 0.0;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> length_s(0.0, 2.0);
  for (int k = 0; k < 1000; ++k) {
    const double dt_s = length_s(random);
    const WarmUpStep step = warm_up_step(warm_up, dt_s);
    bias_mps2 = step.phi * bias_mps2 + step.input_mps2;
    t_s += dt_s;
    ASSERT_NEAR(bias_mps2, bias_at(warm_up, t_s).value, 1e-14) << "t = " << t_s;
  }
}

TEST(WarmUp, AShortStepKeepsAllDigitsOfItsInput) {
  const WarmUpStep step = warm_up_step(thesis_warm_up(), 7e-10);
  EXPECT_DOUBLE_EQ(step.input_mps2, 0.04 * (1e-11 - 0.5e-22));
}

TEST(Departure, IsTheBiasLessWhatItSettlesAt) {
  const WarmUp warm_up = thesis_warm_up(), gone = departure(warm_up);
  for (const double t : {0.0, 10.0, 70.0, 500.0})
    EXPECT_NEAR(bias_at(gone, t).value, bias_at(warm_up, t).value - warm_up.settled_mps2(), 1e-15);
  EXPECT_EQ(gone.settled_mps2(), 0.0);
}

TEST(Departure, IsAsUncertainAsA1AndTLeaveIt) {
  const WarmUp gone = departure(thesis_warm_up());
  const double phi = std::exp(-1.0);
  EXPECT_NEAR(bias_at(gone, 0.0).std, 0.02, 1e-15);
  EXPECT_NEAR(bias_at(gone, 70.0).std, phi * std::hypot(0.02, 0.25 / 70.0 * 5.0), 1e-15);
  EXPECT_NEAR(bias_at(gone, 1e5).std, 0.0, 1e-9);
}

TEST(Departure, KnowsHowA1AndTAreCorrelated) {
  WarmUp warm_up = thesis_warm_up();
  warm_up.covariance = {{{4e-4, 0.0, 0.08}, {0.0, 1e-4, 0.0}, {0.08, 0.0, 25.0}}};
  // At T: ∂/∂a1 = −e⁻¹, ∂/∂T = −e⁻¹ a1/T for the departure; 1 − e⁻¹ and −e⁻¹ a1/T for the bias.
  const double phi = std::exp(-1.0), by_T = phi * 0.25 / 70.0, risen = 1.0 - phi;
  EXPECT_NEAR(bias_at(departure(warm_up), 70.0).std,
              std::sqrt(phi * phi * 4e-4 + by_T * by_T * 25.0 + 2.0 * phi * by_T * 0.08), 1e-15);
  EXPECT_NEAR(
      bias_at(warm_up, 70.0).std,
      std::sqrt(risen * risen * 4e-4 + 1e-4 + by_T * by_T * 25.0 - 2.0 * risen * by_T * 0.08),
      1e-15);
}

TEST(RemoveWarmUp, LeavesReadingsAsOfTheWarmedUpSensor) {
  const WarmUp warm_up = warm_up_of(drift_of_x(), 0).value();
  Recording recording = three_axes(500);
  for (std::size_t k = 0; k < 500; ++k)
    recording.channels[0].values.edit()[k] =
        9.0 + bias_at(warm_up, 12.0 + recording.time.at(k)).value;
  const Recording before = recording;
  ASSERT_TRUE(
      remove_warm_up(drift_of_x(), {"acc", 0, 1, 2}, {.since_switch_on_s = 12.0}, recording));
  for (const double value : recording.channels[0].values)
    ASSERT_NEAR(value, 9.0 + warm_up.settled_mps2(), 1e-14);
  EXPECT_EQ(recording.channels[1].values, before.channels[1].values);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_EQ(recording.notes[0].text,
            "the sensor file has no warm-up of acc_y, acc_z: any warm-up remains in the "
            "data");
}

TEST(RemoveWarmUp, BringsTheChannelToMetresPerSecondSquared) {
  Recording recording = three_axes(2);
  recording.channels[0].unit = *parse_unit("mg");
  ASSERT_TRUE(remove_warm_up(drift_of_x(), {"acc", 0, {}, {}}, {}, recording));
  EXPECT_NEAR(recording.channels[0].values[0], 0.026 * standard_gravity_mps2, 1e-15);
  EXPECT_EQ(recording.channels[0].unit, *parse_unit("m/s^2"));
  EXPECT_TRUE(recording.notes.empty());
}

TEST(RemoveWarmUp, SaysWhyItCannotAndLeavesTheRecordingAlone) {
  const auto refused = [](const DriftModel& drift, Recording recording, const Triad& triad) {
    const Samples before = recording.channels[0].values;
    const Status status = remove_warm_up(drift, triad, {}, recording);
    EXPECT_EQ(recording.channels[0].values, before);
    EXPECT_TRUE(recording.notes.empty());
    return status ? std::string("no error") : status.error().message;
  };
  const Triad all{"acc", 0, 1, 2};
  EXPECT_EQ(refused({}, three_axes(3), all),
            "the sensor file has no drift.a1, a2, T of these axes");
  EXPECT_EQ(refused(drift_of_x(), three_axes(3), {"acc", {}, 1, 2}),
            "the sensor file has no drift.a1, a2, T of these axes");
  DriftModel incomplete = drift_of_x();
  incomplete.time_constant[2] = make_figure(70.0, "s", "fit");
  EXPECT_EQ(refused(incomplete, three_axes(3), all), "drift.a1 of axis z: is missing");
  Recording volts = three_axes(3);
  volts.channels[0].unit = *parse_unit("V");
  EXPECT_TRUE(
      refused(drift_of_x(), volts, all).starts_with("channel acc_x is not an acceleration"));
  Recording timeless = three_axes(3);
  timeless.time = {};
  EXPECT_EQ(refused(drift_of_x(), timeless, all), "a warm-up needs the time of the samples");
}

TEST(RemoveWarmUp, KnowsWhetherThereIsOne) {
  EXPECT_FALSE(has_warm_up({}));
  EXPECT_TRUE(has_warm_up(drift_of_x()));
  DriftModel last;
  last.time_constant[2] = make_figure(70.0, "s", "fit");
  EXPECT_TRUE(has_warm_up(last));
}

}  // namespace
}  // namespace proofmass::sensor::warm_up_test
