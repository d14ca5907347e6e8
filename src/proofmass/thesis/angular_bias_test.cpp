#include "proofmass/thesis/angular_bias.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/thesis/bias/bias_scale_limits.hpp"
#include "proofmass/thesis/bias/tumble_parts.hpp"

namespace proofmass::thesis::angular_bias_test {
namespace {

constexpr double g = standard_gravity_mps2;
constexpr double quarter = std::numbers::pi / 2.0;

const Item& item(const std::vector<Item>& items, std::string_view id) {
  const auto found = std::ranges::find(items, id, &Item::id);
  EXPECT_NE(found, items.end()) << id;
  return *found;
}

const Finding& finding(const Item& item, std::string_view key) {
  const auto found = std::ranges::find(item.findings, key, &Finding::key);
  EXPECT_NE(found, item.findings.end()) << key;
  return *found;
}

const std::vector<Item>& simulated_items() {
  static const std::vector<Item> all = tumble_items(simulate_tumble(1, g).value(), g).value();
  return all;
}

/// Five positions of x and y from table 5.1, in m/s², with a stated noise.
TumbleRecord drawn(std::uint64_t seed, double noise_mps2) {
  TumbleRecord record{.source = "drawn", .simulated = true, .positions = {}, .channels = {}};
  std::array<TumbleChannel, 2> channels;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const PrintedAxis& truth = axis == 0 ? printed_x() : printed_y();
    Random noise(seed, "positions", axis);
    TumbleChannel& channel = channels[axis];
    channel.name = truth.name;
    channel.unit = *parse_unit("m/s^2");
    for (int k = 0; k < 5; ++k) {
      const double phi = k * quarter + (axis == 0 ? 0.0 : quarter);
      channel.output.push_back((1.0 + truth.scale_error) * (truth.bias_mps2 + g * std::sin(phi)) +
                               noise_mps2 * noise.normal());
      channel.std.push_back(noise_mps2);
    }
  }
  for (int k = 0; k < 5; ++k) record.positions.push_back({.angle_rad = k * quarter});
  record.channels = {channels[0], channels[1]};
  return record;
}

TEST(TumbleItems, WorkedReadingsGiveWhatTheirFormulaSays) {
  const Item& table = item(simulated_items(), "table 5.1");
  EXPECT_NEAR(finding(table, "worked_bias_x").ours->value / g, -0.19787, 1e-12);
  EXPECT_NEAR(finding(table, "worked_bias_y").ours->value / g, -0.223795, 1e-12);
  EXPECT_NEAR(finding(table, "worked_scale_error_y").ours->value, 0.809205 - 1.0, 1e-12);
  // The thesis's figures are ten times too small, one of them with the wrong sign.
  EXPECT_NEAR(*finding(table, "worked_bias_x").thesis / g, -0.01978, 1e-12);
  EXPECT_NEAR(*finding(table, "worked_bias_y").thesis / g, 0.02238, 1e-12);
}

TEST(TumbleItems, TheMakersFiguresGiveTheVoltagesOfTheOrientations) {
  const Item& figure = item(simulated_items(), "figure 5.4");
  EXPECT_NEAR(finding(figure, "zero_g").ours->value, 1.65, 1e-12);
  EXPECT_NEAR(finding(figure, "plus_1_g").ours->value, 1.98, 1e-12);
  EXPECT_NEAR(finding(figure, "minus_1_g").ours->value, 1.32, 1e-12);
  EXPECT_NEAR(finding(figure, "sensitivity").ours->value * g, 0.33, 1e-12);
}

// 95 % ± 2 % of 1200 is three standard deviations of the count.
TEST(TumbleItems, IntervalsHoldTheTruthInNineteenOfTwentyTumbles) {
  constexpr int trials = 1200;
  std::array<int, 6> inside{};
  for (int trial = 0; trial < trials; ++trial) {
    const TumbledAxes axes =
        analyse_tumble(drawn(static_cast<std::uint64_t>(trial), 1e-3), g).value();
    std::size_t place = 0;
    for (const PrintedAxis* printed : {&printed_x(), &printed_y()}) {
      const TumbledAxis& axis = *(axes.*printed->place);
      using enum calibrate::TumbleQuantity;
      for (const auto& [quantity, truth] :
           {std::pair{K1, 1.0 + printed->scale_error}, std::pair{K0, printed->bias_mps2},
            std::pair{K0_up_down, printed->bias_mps2}}) {
        const auto* found = axis.fit.find(quantity);
        inside[place++] += std::abs(*found->value - truth) <= *found->half_width_95;
      }
    }
  }
  for (const int count : inside) {
    EXPECT_GT(count, 0.93 * trials);
    EXPECT_LT(count, 0.97 * trials);
  }
}

TEST(TumbleItems, TheSimulatedRecordingGivesBackTable5_1) {
  const TumbledAxes axes = analyse_tumble(simulate_tumble(3, g).value(), g).value();
  for (const PrintedAxis* printed : {&printed_x(), &printed_y()}) {
    const TumbledAxis& axis = *(axes.*printed->place);
    const auto* scale = axis.fit.find(calibrate::TumbleQuantity::K1);
    const auto* bias = axis.fit.find(calibrate::TumbleQuantity::K0);
    EXPECT_NEAR(*scale->value - 1.0, printed->scale_error, 5.0 * *scale->std);
    EXPECT_NEAR(*bias->value, printed->bias_mps2, 5.0 * *bias->std);
    // White noise of 150 µg/√Hz over a minute has a std of 14 µg per mean; quantisation adds to it.
    EXPECT_LT(*scale->std, 3e-5);
    EXPECT_LT(*bias->std, 0.03 * mg_mps2);
  }
}

TEST(TumbleItems, OfYTheOutputsAtTopAndBottomGiveAnotherBiasThanTheLevelOnes) {
  TumbleRecord record = drawn(2, 1e-7);
  for (std::size_t k = 0; k < 5; k += 2) record.channels[1].output[k] += 3.0 * mg_mps2;  // K2 g²
  const auto items = tumble_items(record, g).value();
  const Item& table = item(items, "table 5.1");
  const double up_down = finding(table, "bias_y").ours->value,
               level = finding(table, "bias_other_y").ours->value;
  EXPECT_NEAR(level, printed_y().bias_mps2, 1e-6);
  EXPECT_NEAR((up_down - level) * (1.0 + printed_y().scale_error), 3.0 * mg_mps2, 1e-6);
}

TEST(TumbleItems, TheFittedDeviationGoesThroughFourPositionsWhateverTheirErrors) {
  TumbleRecord record = drawn(2, 1e-7);
  for (std::size_t k = 0; k < 5; ++k) {
    const double turn = static_cast<double>(k % 4);
    record.channels[0].output[k] += mg_mps2 * turn * turn;
  }
  const auto items = tumble_items(record, g).value();
  const report::Figure& figure = item(items, "figure 5.5").figures[1];
  const report::Curve &fitted = figure.curves[0], &measured = figure.curves[2];
  for (std::size_t k = 0; k < 5; ++k) {
    const auto at = std::ranges::find(fitted.x, measured.x[k]) - fitted.x.begin();
    EXPECT_NEAR(fitted.y[static_cast<std::size_t>(at)], measured.y[k], 1e-4) << k;
  }
}

TEST(TumbleItems, AReadingAtZeroIsTheMeanOfBothVisits) {
  const TumbleRecord record = drawn(9, 1e-3);
  const auto items = tumble_items(record, g).value();
  const Finding& reading = finding(item(items, "figure 5.5"), "reading_0");
  const std::vector<double>& output = record.channels[0].output;
  EXPECT_NEAR(reading.ours->value, 0.5 * (output[0] + output[4]), 1e-12);
  EXPECT_NEAR(reading.ours->std, 1e-3 / std::sqrt(2.0), 1e-12);
}

TEST(TumbleItems, AUsersUnitChangesNoFigure) {
  TumbleRecord in_mg = drawn(5, 1e-3);
  for (TumbleChannel& channel : in_mg.channels) {
    channel.unit = *parse_unit("mg");
    for (double& value : channel.output) value /= mg_mps2;
    for (double& value : channel.std) value /= mg_mps2;
  }
  const auto here = tumble_items(drawn(5, 1e-3), g).value(), there = tumble_items(in_mg, g).value();
  for (const char* key : {"bias_x", "scale_error_y"}) {
    const Finding &a = finding(item(here, "table 5.1"), key),
                  &b = finding(item(there, "table 5.1"), key);
    EXPECT_NEAR(a.ours->value, b.ours->value, 1e-12);
    EXPECT_NEAR(a.ours->std, b.ours->std, 1e-12);
  }
}

TEST(TumbleItems, AConstantChannelIsRefusedByName) {
  TumbleRecord record = drawn(1, 1e-3);
  record.channels[1].name = "z";
  std::ranges::fill(record.channels[1].output, 0.2);
  const auto items = tumble_items(record, g).value();
  EXPECT_NE(item(items, "figure 5.6").ours.find("z: "), std::string::npos);
  EXPECT_TRUE(item(items, "figure 5.6").figures.empty());
  EXPECT_FALSE(finding(item(items, "table 5.1"), "bias_y").reason.empty());
  EXPECT_TRUE(finding(item(items, "table 5.1"), "bias_x").ours.has_value());
}

TEST(TumbleItems, FourPositionsOfUnknownNoiseHaveNoStandardDeviation) {
  TumbleRecord record = drawn(1, 1e-3);
  record.positions.pop_back();
  for (TumbleChannel& channel : record.channels) {
    channel.output.pop_back();
    channel.std.assign(4, std::numeric_limits<double>::quiet_NaN());
  }
  const auto items = tumble_items(record, g).value();
  const Finding& bias = finding(item(items, "table 5.1"), "bias_x");
  EXPECT_FALSE(bias.ours.has_value());
  EXPECT_NE(bias.reason.find("without a standard deviation"), std::string::npos);
}

TEST(TumbleItems, CountsHaveNoBiasInMilliG) {
  TumbleRecord record = drawn(1, 1e-3);
  for (TumbleChannel& channel : record.channels) channel.unit = *parse_unit("LSB");
  const auto items = tumble_items(record, g).value();
  EXPECT_FALSE(finding(item(items, "table 5.1"), "bias_x").ours.has_value());
  EXPECT_FALSE(finding(item(items, "figure 5.5"), "reading_0").ours.has_value());
}

TEST(TumbleItems, OfARecordingTheScaleFactorIsAsUncertainAsGravityAtLeast) {
  TumbleRecord own = drawn(1, 1e-5);
  own.simulated = false;
  const auto unplaced = tumble_items(own, g).value(), placed = tumble_items(own, 9.8058).value();
  const Finding &anywhere = finding(item(unplaced, "table 5.1"), "scale_error_x"),
                &there = finding(item(placed, "table 5.1"), "scale_error_x");
  EXPECT_NEAR(anywhere.ours->std, 0.015 / g, 1e-5);
  EXPECT_NEAR(there.ours->std, 4e-4 / g, 1e-6);
  EXPECT_NE(item(placed, "table 5.1").ours.find("In them is the gravity"), std::string::npos);
}

// The mean over T of white noise with one-sided density D has variance D²/(2T).
TEST(TumbleItems, TheDwellIsLongEnoughByMonteCarlo) {
  const double error = printed_x().scale_error, dwell_s = white_dwell_s(error);
  const double mean_std = 150e-6 / std::sqrt(2.0 * dwell_s);
  Random noise(1, "dwell");
  double sum = 0.0;
  constexpr int trials = 20000;
  for (int k = 0; k < trials; ++k) {
    const double K1 = 0.5 * mean_std * (noise.normal() - noise.normal());
    sum += K1 * K1;
  }
  EXPECT_NEAR(std::sqrt(sum / trials), error / 1.96, 0.03 * error / 1.96);
}

TEST(TumbleItems, StandardGravityInHalifaxIsAsLargeAnErrorAsTheOnePrinted) {
  EXPECT_GT(std::abs(standard_gravity_scale_error()), printed_x().scale_error);
  EXPECT_LT(std::abs(standard_gravity_scale_error()), 1.5e-4);
}

TEST(TumbleItems, WhatIsAbsentHasAReason) {
  for (const Item& one : simulated_items())
    for (const Finding& f : one.findings)
      EXPECT_EQ(f.reason.empty(), f.ours.has_value()) << one.id << ' ' << f.key;
}

}  // namespace
}  // namespace proofmass::thesis::angular_bias_test
