#include "proofmass/sensor/calibration_effect.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/units.hpp"

namespace proofmass::sensor::calibration_effect_test {
namespace {

constexpr double g = standard_gravity_mps2;

/// Bias and scale without unit, and their standard deviations.
SensorModel calibrated(const std::array<double, 3>& bias,
                       const std::array<double, 3>& scale,
                       std::optional<double> bias_std = 0.0,
                       std::optional<double> scale_std = 0.0) {
  SensorModel model;
  model.calibration.bias = make_axis_figures(bias, "m/s^2", "");
  model.calibration.scale = make_axis_figures(scale, "1", "");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    model.calibration.bias[axis]->std = bias_std;
    model.calibration.scale[axis]->std = scale_std;
  }
  return model;
}

TEST(CalibrationEffect, OfABiasIsTheBiasEverywhereAndTiltsMostWhereItLiesAcross) {
  const auto effect =
      calibration_effect(calibrated({0, 0, 0}, {1, 1, 1}), calibrated({0.03, 0, 0.04}, {1, 1, 1}))
          .value();
  EXPECT_NEAR(effect.force_mps2.value, 0.05, 1e-12);
  // Sine rule: the angle is largest if it is opposite g in a right triangle.
  EXPECT_NEAR(effect.angle_rad.value, std::asin(0.05 / g), 1e-12);
  EXPECT_EQ(effect.force_mps2.std, 0.0);
  EXPECT_EQ(effect.force_mps2.by_chance_95, 0.0);
  EXPECT_EQ(effect.reading_unit, "m/s^2");
}

TEST(CalibrationEffect, OfAScaleIsLargestAlongItsAxis) {
  const auto effect =
      calibration_effect(calibrated({0, 0, 0}, {1, 1, 1}), calibrated({0, 0, 0}, {1, 1.01, 1}))
          .value();
  EXPECT_NEAR(effect.force_mps2.value, 0.01 * g, 1e-12);
  EXPECT_NEAR(std::abs(effect.force_mps2.up.y()), 1.0, 1e-9);
  // diag(1, k, 1) rotates a direction by at most (k − 1)/(2 √k).
  EXPECT_NEAR(effect.angle_rad.value, std::atan(0.01 / (2.0 * std::sqrt(1.01))), 1e-12);
}

TEST(CalibrationEffect, OfBiasAndScaleAddsWhereTheyPointTheSameWay) {
  const auto effect =
      calibration_effect(calibrated({0, 0, 0}, {1, 1, 1}), calibrated({0, 0, -0.02}, {1, 1, 1.01}))
          .value();
  EXPECT_NEAR(effect.force_mps2.value, 0.02 + 0.01 * g, 1e-12);
  EXPECT_NEAR(effect.force_mps2.up.z(), -1.0, 1e-9);
}

TEST(CalibrationEffect, OfAMisalignmentIsThatAngle) {
  SensorModel before, after;
  after.calibration.misalignment = make_axis_figures({0.002, 0, 0}, "rad", "");
  const auto effect = calibration_effect(before, after).value();
  EXPECT_NEAR(effect.force_mps2.value, 0.002 * g, 1e-10);
  EXPECT_NEAR(effect.angle_rad.value, 0.002, 2e-5);
}

TEST(CalibrationEffect, AddsTheUncertaintiesOfBothFiles) {
  const auto effect = calibration_effect(calibrated({0, 0, 0}, {1, 1, 1}, 0.003),
                                         calibrated({0.1, 0, 0}, {1, 1, 1}, 0.004))
                          .value();
  EXPECT_NEAR(*effect.force_mps2.std, 0.005, 1e-9);
  // The largest of three equal normal components over all directions is their length.
  EXPECT_NEAR(*effect.force_mps2.by_chance_95 / 0.005, std::sqrt(7.8147), 0.05);
  EXPECT_NEAR(*effect.angle_rad.std, 0.005 / g, 2e-6);
  EXPECT_TRUE(effect.without_std.empty());
}

// For one scale with standard deviation s the largest error is g |δ|, whose 95 % quantile is 1.96 g
// s.
TEST(CalibrationEffect, ByChanceIsTheQuantileOfTheLargestError) {
  SensorModel before, after;
  before.calibration.scale[2] = make_figure(1.0, "1", "old");
  after.calibration.scale[2] = make_figure(1.0001, "1", "new");
  before.calibration.scale[2]->std = 0.0;
  after.calibration.scale[2]->std = 1e-4;
  auto effect = calibration_effect(before, after).value();
  EXPECT_NEAR(*effect.force_mps2.by_chance_95 / (1.96e-4 * g), 1.0, 0.04);
  // diag(1, 1, k) rotates a direction by half of k − 1.
  EXPECT_NEAR(*effect.angle_rad.by_chance_95 / 0.98e-4, 1.0, 0.04);
  // With two degrees of freedom Student's t has its 97.5 % quantile at 4.303.
  after.calibration.dof = make_figure(2.0, "1", "");
  effect = calibration_effect(before, after).value();
  EXPECT_NEAR(*effect.force_mps2.by_chance_95 / (4.303e-4 * g), 1.0, 0.1);
}

// The angle is asin(b/g), whose slope is 1/(g cos).
TEST(CalibrationEffect, KnowsHowUncertainALargeAngleIs) {
  SensorModel after = calibrated({3.0, 0, 0}, {1, 1, 1});
  after.calibration.bias[0]->std = 0.01;
  const auto effect = calibration_effect(calibrated({0, 0, 0}, {1, 1, 1}), after).value();
  const double angle = std::asin(3.0 / g);
  EXPECT_NEAR(effect.angle_rad.value, angle, 1e-9);
  EXPECT_NEAR(*effect.angle_rad.std, 0.01 / (g * std::cos(angle)), 1e-6);
}

TEST(CalibrationEffect, TakesCorrelationsFromTheCovariance) {
  SensorModel before = calibrated({0, 0, 0}, {1, 1, 1});
  SensorModel after = calibrated({0.1, 0, 0}, {1.01, 1, 1}, 0.01, 0.01 / g);
  for (const double r : {-1.0, 0.0, 1.0}) {
    auto& C = after.calibration.covariance.emplace();
    for (auto& row : C) row.fill(0.0);
    C[0][0] = 1e-4;
    C[3][3] = 1e-4 / (g * g);
    C[0][3] = C[3][0] = r * 1e-4 / g;
    const auto effect = calibration_effect(before, after).value();
    // At u = +x the error is −(b + g (k − 1))/k: the two parts add for r = 1 and cancel for r = −1.
    EXPECT_NEAR(effect.force_mps2.up.x(), 1.0, 1e-6);
    EXPECT_NEAR(*effect.force_mps2.std, 0.01 * std::sqrt(2.0 + 2.0 * r), 3e-4);
  }
}

TEST(CalibrationEffect, HoldsWhatWasCarriedOverForTheSame) {
  const SensorModel before = calibrated({0, 0, 0}, {1, 1, 1}, 0.003, 1e-3);
  SensorModel after = before;
  after.calibration.bias[0]->value = 0.1;
  const auto effect = calibration_effect(before, after).value();
  EXPECT_NEAR(*effect.force_mps2.std, 0.003 * std::sqrt(2.0), 1e-9);
  const auto none = calibration_effect(before, before).value();
  EXPECT_EQ(none.force_mps2.value, 0.0);
  EXPECT_EQ(none.force_mps2.by_chance_95, 0.0);
}

TEST(CalibrationEffect, ComparesCalibrationsOfVoltsInWhateverMultiple) {
  const auto in = [](double factor, const char* bias, const char* scale) {
    SensorModel model;
    model.calibration.bias = make_axis_figures({1.65 * factor, 0, 0}, bias, "");
    model.calibration.scale =
        make_axis_figures({0.033 * factor, 0.033 * factor, 0.033 * factor}, scale, "");
    return model;
  };
  SensorModel milli = in(1e3, "mV", "mV/(m/s^2)");
  const SensorModel volts = in(1.0, "V", "V/(m/s^2)");
  EXPECT_NEAR(calibration_effect(volts, milli).value().force_mps2.value, 0.0, 1e-11);
  milli.calibration.bias[0]->value += 3.3;
  const auto effect = calibration_effect(volts, milli).value();
  EXPECT_NEAR(effect.force_mps2.value, 0.1, 1e-11);
  EXPECT_EQ(effect.reading_unit, "V");
}

TEST(CalibrationEffect, FindsTheReadingsThatBothCanTake) {
  SensorModel volts, counts;
  volts.calibration.scale = make_axis_figures({0.033, 0.033, 0.033}, "V/(m/s^2)", "");
  counts.calibration.scale = make_axis_figures({66.66, 66, 66}, "counts/(m/s^2)", "");
  EXPECT_FALSE(calibration_effect(volts, counts));
  volts.electrical.lsb = make_figure(0.5, "mV", "");
  const auto effect = calibration_effect(volts, counts).value();
  EXPECT_EQ(effect.reading_unit, "counts");
  EXPECT_NEAR(effect.force_mps2.value, 0.01 * g, 1e-10);
}

TEST(CalibrationEffect, TakesASupplyThatIsRecordedForTheNominalOne) {
  SensorModel model;
  model.electrical.supply_channel = "rail";
  model.electrical.reference_supply = make_figure(3.0, "V", "");
  model.calibration.scale = make_axis_figures({0.033, 0.033, 0.033}, "V/(m/s^2)", "");
  SensorModel other = model;
  other.electrical.supply = make_figure(3.3, "V", "");
  EXPECT_NEAR(calibration_effect(model, other).value().force_mps2.value, 0.1 * g, 1e-10);
}

TEST(CalibrationEffect, SaysWhyThereIsNoUncertainty) {
  const SensorModel with = calibrated({0, 0, 0}, {1, 1, 1}, 0.01, 1e-3);
  const SensorModel without = calibrated({0.1, 0, 0}, {1, 1, 1}, std::nullopt, 1e-3);
  const auto effect = calibration_effect(without, with).value();
  EXPECT_NEAR(effect.force_mps2.value, 0.1, 1e-12);
  EXPECT_FALSE(effect.force_mps2.std);
  EXPECT_FALSE(effect.angle_rad.by_chance_95);
  EXPECT_EQ(effect.without_std, "OLD: a calibration figure has no standard deviation");
}

TEST(CalibrationEffect, SaysWhyItCannot) {
  SensorModel bad = calibrated({0, 0, 0}, {1, 0, 1});
  const auto zero = calibration_effect(calibrated({0, 0, 0}, {1, 1, 1}), bad);
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().message, "NEW: calibration.scale must not be 0");
}

}  // namespace
}  // namespace proofmass::sensor::calibration_effect_test
