#include "proofmass/calibrate/supply.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/calibrate/uncertainty/draw.hpp"

namespace proofmass::calibrate::supply_test {
namespace {

// ADXL335: half the supply at 0 g, 300 mV/g at 3 V.
constexpr double fraction = 0.5, scale_at_3v = 0.300 / 9.80665;

SupplyPoint ratiometric(double V, double supply_std, double bias_std, double relative_std) {
  SupplyPoint point{.supply_v = {V, supply_std}, .bias = {}, .scale = {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point.bias[axis] = Uncertain{fraction * V, bias_std};
    const double scale = scale_at_3v * V / 3.0;
    point.scale[axis] = Uncertain{scale, relative_std * scale};
  }
  return point;
}

std::vector<SupplyPoint> ratiometric_set(double bias_std = 1e-4, double relative_std = 1e-3) {
  std::vector<SupplyPoint> points;
  for (const double V : {2.4, 2.7, 3.0, 3.3, 3.6})
    points.push_back(ratiometric(V, 1e-4, bias_std, relative_std));
  return points;
}

TEST(FitSupply, OfAnExactlyRatiometricSensorIsPowerOneAndNoConstant) {
  const auto found = fit_supply(ratiometric_set(), {.reference_v = 3.0}).value();
  for (const auto& axis : found.axes) {
    EXPECT_NEAR(axis->exponent.value, 1.0, 1e-12);
    EXPECT_NEAR(axis->fraction.value, 0.5, 1e-12);
    EXPECT_NEAR(axis->constant.value, 0.0, 1e-11);
    EXPECT_NEAR(axis->scale_ref.value, scale_at_3v, 1e-12);
    EXPECT_NEAR(axis->zero_ref.value, 1.5, 1e-12);
    EXPECT_NEAR(*axis->scale_p, 1.0, 1e-6);
    EXPECT_TRUE(*axis->ratiometric);
  }
  EXPECT_EQ(found.axes[0]->words,
            "x follows its supply: scale as V^1.0000 ± 0.0031, zero moves 500.00 ± 0.12 mV/V "
            "where 500 mV/V was expected");
  EXPECT_TRUE(found.notes.empty());
}

// Weighted least squares in closed form, with equal weights in ln V.
TEST(FitSupply, StatesTheStandardDeviationOfTheLine) {
  std::vector<SupplyPoint> points = ratiometric_set(1e-3, 1e-3);
  for (SupplyPoint& point : points) point.supply_v.std = 0.0;
  const auto found = fit_supply(points).value();
  double mean = 0.0, squares = 0.0, log_mean = 0.0, log_squares = 0.0;
  for (const SupplyPoint& p : points) mean += p.supply_v.value / 5.0;
  for (const SupplyPoint& p : points) log_mean += std::log(p.supply_v.value) / 5.0;
  for (const SupplyPoint& p : points) {
    squares += std::pow(p.supply_v.value - mean, 2);
    log_squares += std::pow(std::log(p.supply_v.value) - log_mean, 2);
  }
  EXPECT_NEAR(found.axes[1]->fraction.std, 1e-3 / std::sqrt(squares), 1e-12);
  EXPECT_NEAR(found.axes[1]->constant.std, 1e-3 * std::sqrt(1 / 5.0 + mean * mean / squares),
              1e-12);
  EXPECT_NEAR(found.axes[1]->exponent.std, 1e-3 / std::sqrt(log_squares), 1e-12);
}

TEST(FitSupply, NamesAZeroThatStaysWhereItIs) {
  std::vector<SupplyPoint> points = ratiometric_set();
  for (SupplyPoint& point : points)
    point.bias[2] = Uncertain{1.5 + 0.012 * (point.supply_v.value - 3.0), 1e-4};
  const auto found = fit_supply(points, {.reference_v = 3.0}).value();
  EXPECT_FALSE(*found.axes[2]->ratiometric);
  EXPECT_TRUE(*found.axes[0]->ratiometric);
  EXPECT_NE(found.axes[2]->words.find("z's zero does not follow its supply"), std::string::npos);
  EXPECT_NE(found.axes[2]->words.find("zero moves 12.00 ± 0.11 mV/V where 500 mV/V was expected"),
            std::string::npos)
      << found.axes[2]->words;
}

TEST(FitSupply, NamesASensorThatDoesNotMoveAtAll) {
  std::vector<SupplyPoint> points = ratiometric_set();
  for (SupplyPoint& point : points) {
    point.bias[0] = Uncertain{33000.0, 1.0};
    point.scale[0] = Uncertain{-414.0, 0.1};
  }
  const auto found = fit_supply(points, {.reading_unit = "counts"}).value();
  EXPECT_NE(found.axes[0]->words.find("x does not move with its supply"), std::string::npos);
  EXPECT_NE(found.axes[0]->words.find("counts/V were expected"), std::string::npos);
  EXPECT_NEAR(at_supply(found, 0, 3.1).scale->value, -414.0, 1e-9);
}

TEST(FitSupply, RejectsTheTruthInFivePercentAndItsIntervalsHoldIt) {
  Draw draw(4);
  double rejected = 0, exponent_inside = 0, constant_inside = 0, value_inside = 0;
  constexpr int sets = 2000;
  for (int set = 0; set < sets; ++set) {
    std::vector<SupplyPoint> points = ratiometric_set(2e-3, 2e-3);
    for (SupplyPoint& p : points) {
      p.supply_v = {p.supply_v.value + 5e-3 * draw.normal(), 5e-3};
      p.bias[0]->value += p.bias[0]->std * draw.normal();
      p.scale[0]->value += p.scale[0]->std * draw.normal();
    }
    const auto found = fit_supply(points, {.reference_v = 3.0}).value();
    const SupplyAxis& x = *found.axes[0];
    rejected += *x.ratiometric ? 0.0 : 1.0;
    const auto inside = [](const Uncertain& it, double truth, double dof) {
      const double k = dof > 0.0 ? 3.18 : 1.96;
      return std::abs(it.value - truth) <= k * it.std ? 1.0 : 0.0;
    };
    exponent_inside += inside(x.exponent, 1.0, x.log_scale.dof);
    constant_inside += inside(x.constant, 0.0, x.zero.dof);
    value_inside += inside(*at_supply(found, 0, 2.8).bias, 1.4, x.zero.dof);
  }
  EXPECT_NEAR(rejected / sets, 0.05, 0.02);
  EXPECT_NEAR(exponent_inside / sets, 0.95, 0.02);
  EXPECT_NEAR(constant_inside / sets, 0.95, 0.02);
  EXPECT_NEAR(value_inside / sets, 0.95, 0.02);
}

TEST(FitSupply, ReportsThatTwoSuppliesHaveNoRedundancy) {
  const std::vector<SupplyPoint> points{ratiometric(3.0, 0.0, 1e-3, 1e-3),
                                        ratiometric(3.3, 0.0, 1e-3, 1e-3)};
  const auto found = fit_supply(points).value();
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("no redundancy"), std::string::npos);
  EXPECT_TRUE(*found.axes[0]->ratiometric);
  EXPECT_FALSE(found.axes[0]->zero.misfit_p);

  const std::vector<SupplyPoint> bare{ratiometric(3.0, 0, 0, 0), ratiometric(3.3, 0, 0, 0)};
  const auto unsure = fit_supply(bare).value();
  EXPECT_FALSE(unsure.axes[0]->scale_p);
  EXPECT_FALSE(unsure.axes[0]->ratiometric);
  EXPECT_NE(unsure.axes[0]->words.find("undetermined"), std::string::npos);
  EXPECT_FALSE(at_supply(unsure, 0, 3.1).reason.empty());
}

TEST(FitSupply, WithoutUncertaintiesTakesThemFromTheResiduals) {
  std::vector<SupplyPoint> points;
  for (const double V : {2.4, 2.7, 3.0, 3.3, 3.6}) points.push_back(ratiometric(V, 0, 0, 0));
  const auto exact = fit_supply(points).value();
  EXPECT_TRUE(*exact.axes[0]->ratiometric);
  EXPECT_EQ(exact.axes[0]->zero.dof, 3.0);
  points[1].bias[0]->value += 1e-3;
  const auto found = fit_supply(points).value();
  EXPECT_GT(found.axes[0]->constant.std, 1e-4);
}

TEST(FitSupply, ReportsANonlinearDependence) {
  std::vector<SupplyPoint> points = ratiometric_set();
  points[2].bias[0]->value += 0.05;
  const auto found = fit_supply(points).value();
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("x: its zero deviates from the line"), std::string::npos);
  EXPECT_GT(found.axes[0]->fraction.std, 0.01);
}

TEST(AtSupply, InterpolatesAndDoesNotExtrapolate) {
  const auto found = fit_supply(ratiometric_set()).value();
  const AtSupply inside = at_supply(found, 1, 3.15);
  EXPECT_NEAR(inside.bias->value, 1.575, 1e-12);
  EXPECT_NEAR(inside.scale->value, scale_at_3v * 1.05, 1e-12);
  EXPECT_GT(inside.scale->std, 0.0);
  EXPECT_TRUE(inside.reason.empty());
  EXPECT_TRUE(at_supply(found, 1, 2.4).bias);
  EXPECT_TRUE(at_supply(found, 1, 3.6).bias);
  for (const double V : {2.39, 3.61, 0.0, -1.0, std::nan("")}) {
    const AtSupply outside = at_supply(found, 1, V);
    EXPECT_FALSE(outside.bias || outside.scale);
    EXPECT_NE(outside.reason.find("outside the supplies"), std::string::npos);
  }
}

TEST(FitSupply, LeavesOutAnAxisThatIsNotThereAndSaysWhyItCannot) {
  std::vector<SupplyPoint> points = ratiometric_set();
  for (SupplyPoint& point : points) point.scale[1].reset();
  const auto found = fit_supply(points).value();
  EXPECT_FALSE(found.axes[1]);
  EXPECT_FALSE(at_supply(found, 1, 3.0).reason.empty());
  EXPECT_EQ(found.notes.size(), 1U);

  const auto code = [](const std::vector<SupplyPoint>& set) {
    return fit_supply(set).error().code;
  };
  EXPECT_EQ(code({}), Errc::too_few_samples);
  EXPECT_EQ(code({ratiometric(3.0, 0, 0, 0)}), Errc::too_few_samples);
  EXPECT_EQ(code({ratiometric(3.0, 0, 0, 0), ratiometric(3.0, 0, 0, 0)}), Errc::not_observable);
  EXPECT_EQ(code({ratiometric(3.0, 0.1, 0, 0), ratiometric(3.1, 0.1, 0, 0)}), Errc::not_observable);
  EXPECT_EQ(code({ratiometric(3.0, 0, 0, 0), ratiometric(-3.0, 0, 0, 0)}), Errc::invalid_argument);
  EXPECT_EQ(code({ratiometric(3.0, 0, 0, 0), ratiometric(std::nan(""), 0, 0, 0)}),
            Errc::not_finite);
  points[0].scale[0]->value *= -1.0;
  EXPECT_EQ(code(points), Errc::invalid_argument);
  points[0].scale[0]->value = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(points), Errc::not_finite);
}

}  // namespace
}  // namespace proofmass::calibrate::supply_test
