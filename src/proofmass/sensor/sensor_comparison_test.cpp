#include "proofmass/sensor/sensor_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/sensor/file/fields.hpp"

namespace proofmass::sensor::sensor_comparison_test {
namespace {

using Covariance = std::array<std::array<double, 9>, 9>;
constexpr std::array<double, 9> truth{33123.8, 33275.2, 32364.5, 414.4, 412.0,
                                      414.6,   0.003,   -0.009,  0.021};
constexpr std::array<double, 9> stds{0.25, 0.14, 0.15, 0.027, 0.014, 0.016, 1.3e-4, 4.8e-4, 1.2e-4};

/// Every pair of figures has a correlation of 0.6: one common error in addition to nine individual
/// ones.
constexpr double shared = 0.6;

using Normal = std::normal_distribution<double>;

/// A calibration of the true values with errors from its covariance, as a fit with `dof` would
/// report it.
SensorModel drawn(std::mt19937_64& engine, bool with_covariance, std::optional<double> dof) {
  Normal normal;
  double factor = 1.0;
  if (dof) factor = std::sqrt(std::chi_squared_distribution<double>(*dof)(engine) / *dof);
  SensorModel model;
  Calibration& c = model.calibration;
  c.bias = make_axis_figures({0, 0, 0}, "counts", "");
  c.scale = make_axis_figures({0, 0, 0}, "counts/(m/s^2)", "");
  c.misalignment = make_axis_figures({0, 0, 0}, "rad", "");
  const auto figures = nine_figures(c);
  const double common = normal(engine);
  for (std::size_t k = 0; k < 9; ++k) {
    const double error = std::sqrt(shared) * common + std::sqrt(1.0 - shared) * normal(engine);
    (*figures[k])->value = truth[k] + stds[k] * error;
    (*figures[k])->std = stds[k] * factor;
  }
  if (dof) c.dof = make_figure(*dof, "1", "");
  if (!with_covariance) return model;
  Covariance& C = c.covariance.emplace();
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      C[i][j] = (i == j ? 1.0 : shared) * stds[i] * stds[j] * factor * factor;
  return model;
}

constexpr ComparisonOptions quick{.level = 0.05, .with_effect = false};

double alarm_rate(bool with_covariance, std::optional<double> dof, int pairs) {
  std::mt19937_64 engine(7);
  int alarms = 0;
  for (int k = 0; k < pairs; ++k) {
    const SensorModel before = drawn(engine, with_covariance, dof);
    const SensorModel after = drawn(engine, with_covariance, dof);
    if (compare(before, after, quick).all == Verdict::changed) ++alarms;
  }
  return static_cast<double>(alarms) / pairs;
}

const FigureComparison& at(const SensorComparison& comparison, std::string_view name) {
  const auto found = std::ranges::find_if(
      comparison.figures, [&](const FigureComparison& f) { return f.before.name() == name; });
  EXPECT_NE(found, comparison.figures.end()) << name;
  return *found;
}

SensorModel with_bias(double value, std::optional<double> std, const char* unit = "m/s^2") {
  SensorModel model;
  model.calibration.bias[0] = make_figure(value, unit, "");
  model.calibration.bias[0]->std = std;
  return model;
}

// 5 % ± 0.34 % (one standard deviation) of 4000.
TEST(SensorComparison, AlarmsInFivePercentOfCalibrationsOfOneTruth) {
  EXPECT_NEAR(alarm_rate(true, std::nullopt, 4000), 0.05, 0.011);
}

TEST(SensorComparison, AlarmsInFivePercentWhereTheUncertaintyIsItselfUncertain) {
  EXPECT_NEAR(alarm_rate(true, 15.0, 4000), 0.05, 0.011);
  EXPECT_NEAR(alarm_rate(true, 6.0, 4000), 0.05, 0.015);
}

// Holm's method ignores the correlation of the figures, and can only be conservative.
TEST(SensorComparison, AlarmsInFivePercentAtMostWithoutCovariances) {
  const double rate = alarm_rate(false, std::nullopt, 4000);
  EXPECT_LT(rate, 0.05);
  EXPECT_GT(rate, 0.01);
}

TEST(SensorComparison, FindsTheFigureThatChanged) {
  std::mt19937_64 engine(11);
  int found = 0, false_alarms = 0;
  for (int k = 0; k < 300; ++k) {
    const SensorModel before = drawn(engine, true, std::nullopt);
    SensorModel after = drawn(engine, true, std::nullopt);
    after.calibration.scale[1]->value += 6.0 * std::sqrt(2.0) * stds[4];
    const SensorComparison comparison = compare(before, after, quick);
    if (at(comparison, "calibration.scale y").verdict == Verdict::changed) ++found;
    if (std::ranges::any_of(comparison.figures, [](const FigureComparison& f) {
          return f.verdict == Verdict::changed && f.before.name() != "calibration.scale y";
        }))
      ++false_alarms;
  }
  EXPECT_GT(found, 290);
  EXPECT_LT(false_alarms, 25);  // 5 % of 300 are 15 ± 3.8
}

TEST(SensorComparison, TestsOneFigureAsTheNormalDistributionDoes) {
  const auto comparison = compare(with_bias(0.0, 0.003), with_bias(0.0098, 0.004));
  const FigureComparison& bias = at(comparison, "calibration.bias x");
  EXPECT_NEAR(*bias.change, 0.0098, 1e-15);
  EXPECT_NEAR(*bias.change_std, 0.005, 1e-15);
  EXPECT_NEAR(*bias.in_stds(), 1.96, 1e-12);
  EXPECT_NEAR(*bias.p, 0.05, 1e-4);
  EXPECT_EQ(bias.p, bias.p_adjusted);
  EXPECT_EQ(bias.verdict, Verdict::changed);
  EXPECT_EQ(comparison.all, Verdict::changed);
  EXPECT_EQ(comparison.tests, 1U);
  EXPECT_NEAR(comparison.effect->force_mps2.value, 0.0098, 1e-12);
}

// Welch's 12.48 degrees of freedom: Student's t has 0.072706 beyond ±1.96 (scipy.stats.t).
TEST(SensorComparison, TestsFewDegreesOfFreedomAsStudentsTDoes) {
  SensorModel before = with_bias(0.0, 0.003), after = with_bias(0.0098, 0.004);
  before.calibration.dof = make_figure(6.0, "1", "");
  after.calibration.dof = make_figure(7.0, "1", "");
  const auto comparison = compare(before, after, quick);
  EXPECT_NEAR(*at(comparison, "calibration.bias x").p, 0.072706, 1e-6);
  EXPECT_EQ(comparison.all, Verdict::same);
}

// S. Holm's steps by hand: 0.01, 0.04, 0.03 become 0.03, 0.06, 0.06.
TEST(SensorComparison, AdjustsTheProbabilitiesAsHolmDoes) {
  SensorModel before, after;
  constexpr std::array z{2.5758293, 2.0537489, 2.1700904};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    before.noise.white[axis] = make_figure(1.0, "m/s^2/sqrt(Hz)", "old");
    after.noise.white[axis] = make_figure(1.0 + z[axis], "m/s^2/sqrt(Hz)", "new");
    before.noise.white[axis]->std = 0.0;
    after.noise.white[axis]->std = 1.0;
  }
  const auto comparison = compare(before, after, quick);
  EXPECT_NEAR(*at(comparison, "noise.white x").p_adjusted, 0.03, 1e-6);
  EXPECT_NEAR(*at(comparison, "noise.white y").p_adjusted, 0.06, 1e-6);
  EXPECT_NEAR(*at(comparison, "noise.white z").p_adjusted, 0.06, 1e-6);
  EXPECT_EQ(at(comparison, "noise.white x").verdict, Verdict::changed);
  EXPECT_EQ(at(comparison, "noise.white z").verdict, Verdict::same);
  EXPECT_EQ(comparison.all, Verdict::changed);
  EXPECT_EQ(comparison.calibration, Verdict::cannot_tell);
}

TEST(SensorComparison, TestsTheCalibrationAsAWholeByChiSquare) {
  std::mt19937_64 engine(3);
  const SensorModel before = drawn(engine, true, std::nullopt);
  SensorModel after = before;
  // For equicorrelated figures, all shifted by their own standard deviation of the change: the
  // eigenvector (1, …, 1) with eigenvalue 1 + 8 · 0.6.
  for (auto* figure : nine_figures(after.calibration)) {
    (*figure)->value += std::sqrt(2.0) * *(*figure)->std;
    (*figure)->origin = "again";
  }
  const auto comparison = compare(before, after, quick);
  ASSERT_TRUE(comparison.joint);
  EXPECT_EQ(comparison.joint->figures, 9U);
  EXPECT_NEAR(comparison.joint->statistic, 9.0 / 5.8, 1e-6);
  EXPECT_EQ(comparison.tests, 1U);
  EXPECT_EQ(comparison.calibration, Verdict::same);
}

TEST(SensorComparison, MayFindAChangeThatNoSingleFigureShows) {
  std::mt19937_64 engine(3);
  const SensorModel before = drawn(engine, true, std::nullopt);
  SensorModel after = before;
  double sign = 1.5;
  for (auto* figure : nine_figures(after.calibration)) {
    (*figure)->value += (sign = -sign) * std::sqrt(2.0) * *(*figure)->std;
    (*figure)->origin = "again";
  }
  const auto comparison = compare(before, after, quick);
  EXPECT_LT(comparison.joint->p, 1e-6);
  EXPECT_EQ(comparison.calibration, Verdict::changed);
  for (const FigureComparison& figure : comparison.figures)
    EXPECT_EQ(figure.verdict, Verdict::same);
}

TEST(SensorComparison, ConvertsUnits) {
  const auto same = compare(with_bias(1.65, 1e-3, "V"), with_bias(1650.5, 1.0, "mV"), quick);
  const FigureComparison& bias = at(same, "calibration.bias x");
  EXPECT_NEAR(*bias.change, 5e-4, 1e-12);
  EXPECT_NEAR(*bias.change_std, std::sqrt(2.0) * 1e-3, 1e-12);
  EXPECT_EQ(bias.unit, "V");
  EXPECT_EQ(bias.verdict, Verdict::same);
  const auto other = compare(with_bias(1.65, 1e-3, "V"), with_bias(1650.5, 1.0, "counts"), quick);
  EXPECT_EQ(at(other, "calibration.bias x").verdict, Verdict::cannot_tell);
  EXPECT_EQ(at(other, "calibration.bias x").reason, "OLD is in V, NEW in counts");
}

TEST(SensorComparison, SaysWhatIsNotDetermined) {
  const auto reason = [](std::optional<double> a, std::optional<double> b) {
    const auto comparison = compare(with_bias(0.0, a), with_bias(1.0, b), quick);
    EXPECT_EQ(comparison.all, Verdict::cannot_tell);
    EXPECT_FALSE(at(comparison, "calibration.bias x").p);
    return at(comparison, "calibration.bias x").reason;
  };
  EXPECT_EQ(reason(std::nullopt, 0.1), "no uncertainty in OLD");
  EXPECT_EQ(reason(0.1, std::nullopt), "no uncertainty in NEW");
  EXPECT_EQ(reason(std::nullopt, std::nullopt), "no uncertainty in OLD and NEW");
}

TEST(SensorComparison, TakesWhatIsExactForExact) {
  EXPECT_EQ(compare(with_bias(0.0, 0.0), with_bias(1e-9, 0.0), quick).all, Verdict::changed);
  SensorModel renamed = with_bias(0.0, 0.0);
  renamed.calibration.bias[0]->origin = "elsewhere";
  EXPECT_EQ(compare(with_bias(0.0, 0.0), renamed, quick).all, Verdict::same);
}

TEST(SensorComparison, OfAFileWithItselfTestsNothing) {
  std::mt19937_64 engine(3);
  const SensorModel model = drawn(engine, true, 15.0);
  const auto comparison = compare(model, model);
  EXPECT_EQ(comparison.all, Verdict::unchanged);
  EXPECT_EQ(comparison.calibration, Verdict::unchanged);
  EXPECT_EQ(comparison.tests, 0U);
  EXPECT_FALSE(comparison.joint);
  EXPECT_EQ(comparison.effect->force_mps2.value, 0.0);
}

TEST(SensorComparison, LeavesFiguresThatWereCarriedOverOutOfTheTests) {
  std::mt19937_64 engine(5);
  const SensorModel before = drawn(engine, true, std::nullopt);
  SensorModel after = before;
  after.calibration.bias[0]->value += 0.1;
  after.calibration.scale[0]->value += 0.01;
  const auto comparison = compare(before, after, quick);
  EXPECT_EQ(comparison.joint->figures, 2U);
  EXPECT_EQ(at(comparison, "calibration.bias y").verdict, Verdict::unchanged);
  after.calibration.covariance.reset();
  const auto without = compare(before, after, quick);
  EXPECT_EQ(without.no_joint, "no covariance in NEW");
  EXPECT_EQ(without.tests, 2U);
}

TEST(SensorComparison, ListsFiguresOfOneFileOnlyAndConditions) {
  SensorModel before = with_bias(0.0, 0.1), after = with_bias(0.1, 0.1);
  before.noise.flicker[2] = make_figure(1e-3, "m/s^2", "");
  after.drift.a1[1] = make_figure(1e-3, "m/s^2", "");
  before.calibration.temperature = make_figure(20.0, "degC", "");
  after.calibration.temperature = make_figure(303.15, "K", "");
  before.calibration.gravity = make_figure(9.80665, "m/s^2", "");
  after.calibration.gravity = make_figure(9.81665, "m/s^2", "");
  before.serial = "1";
  after.serial = "2";
  const auto comparison = compare(before, after, quick);
  EXPECT_EQ(at(comparison, "noise.flicker z").verdict, Verdict::only_old);
  EXPECT_EQ(at(comparison, "drift.a1 y").verdict, Verdict::only_new);
  EXPECT_EQ(at(comparison, "calibration.temperature").verdict, Verdict::condition);
  EXPECT_NEAR(*at(comparison, "calibration.temperature").change, 10.0, 1e-10);
  EXPECT_EQ(comparison.all, Verdict::same);
  const auto is_noted = [&](std::string_view words) {
    return std::ranges::any_of(comparison.notes, [&](const Note& note) {
      return note.text.find(words) != std::string::npos;
    });
  };
  EXPECT_EQ(comparison.notes.size(), 4U);
  EXPECT_TRUE(is_noted("10.0 K apart"));
  EXPECT_TRUE(is_noted("0.1 %"));
}

TEST(FigureSlot, NamesItsPlace) {
  const auto slots = figure_slots(SensorModel{});
  EXPECT_TRUE(std::ranges::all_of(slots, [](const FigureSlot& s) { return !s.figure; }));
  EXPECT_TRUE(std::ranges::any_of(
      slots, [](const FigureSlot& s) { return s.name() == "calibration.misalignment zx"; }));
  EXPECT_TRUE(std::ranges::any_of(
      slots, [](const FigureSlot& s) { return s.name() == "electrical.supply"; }));
}

}  // namespace
}  // namespace proofmass::sensor::sensor_comparison_test
