#include "proofmass/thesis/static_bias.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string_view>

#include "proofmass/core/random.hpp"

namespace proofmass::thesis::static_bias_test {
namespace {

using characterise::Interval95;

constexpr double milli_g = 1e-3 * standard_gravity_mps2;

// --- the simulated test --------------------------------------------------------------------------

/// A quarter of the thesis's two hours, computed once for all tests.
const StaticTest& half_an_hour() {
  static const StaticTest test = analyse_static(simulate_static(1, {}, 1800.0).value(), {}).value();
  return test;
}

const Item& item_of(const std::vector<Item>& items, std::string_view id) {
  const auto item = std::ranges::find(items, id, &Item::id);
  EXPECT_NE(item, items.end()) << id;
  return *item;
}

const Finding& finding_of(const Item& item, std::string_view key) {
  const auto finding = std::ranges::find(item.findings, key, &Finding::key);
  EXPECT_NE(finding, item.findings.end()) << key;
  return *finding;
}

const std::vector<Item>& simulated_items() {
  static const std::vector<Item> items = static_items(half_an_hour());
  return items;
}

void expect_within(const std::optional<Interval95>& interval, double truth) {
  ASSERT_TRUE(interval);
  EXPECT_LE(interval->lower_95.value(), truth);
  EXPECT_GE(interval->upper_95.value(), truth);
}

TEST(StaticSimulation, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const auto once = simulate_static(3, {}, 10.0).value();
  EXPECT_EQ(simulate_static(3, {}, 10.0).value().axes[3].accel_mps2, once.axes[3].accel_mps2);
  EXPECT_NE(simulate_static(4, {}, 10.0).value().axes[3].accel_mps2, once.axes[3].accel_mps2);
  EXPECT_EQ(once.axes[3].name, "y2");
  EXPECT_EQ(once.axes[3].accel_mps2.size(), 400U);
}

TEST(StaticSimulation, HasNoGravityInItsAxes) {
  const StaticRecord record = simulate_static(1, {}, 10.0).value();
  for (const StaticAxis& axis : record.axes) {
    double sum = 0.0;
    for (std::size_t k = 0; k < axis.accel_mps2.size(); ++k)
      sum += axis.accel_mps2[k] - axis.true_bias_mps2[k];
    // White noise of 106 µg/√Hz over 10 s.
    EXPECT_LT(std::abs(sum / 400.0), 4.0 * 0.106 / std::sqrt(10.0) * milli_g) << axis.name;
  }
}

// Four axes with three intervals each: at 95 % eleven or twelve of them cover, in nine cases of
// ten.
TEST(StaticTest, FindsTheWarmUpThatWasSimulated) {
  const StaticTest& test = half_an_hour();
  ASSERT_EQ(test.axes.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const characterise::DriftFit& fit = test.axes[k].drift->fit;
    ASSERT_TRUE(fit.identified) << fit.reason;
    expect_within(fit.a1, 0.25);
    expect_within(fit.a2, test.record.axes[k].true_warm_up->a2_mps2);
    expect_within(fit.time_constant_s, 70.0);
  }
}

TEST(StaticTest, PlainLeastSquaresUnderestimateTheirError) {
  double squares = 0.0;
  for (const AxisTest& axis : half_an_hour().axes) {
    const double error =
        (axis.plain->time_constant_s.value - 70.0) / axis.plain->time_constant_s.std;
    squares += error * error;
  }
  EXPECT_GT(std::sqrt(squares / 4.0), 1.5);
}

// ADXL335: 150 µg/√Hz one-sided is N = 106.1 two-sided. With a bandwidth of 49.7 Hz (32 kΩ, 0.1
// µF), 40 samples a second alias to √(x coth x) of it, x = π 49.7/40, and 1000 a second to 1.004.
TEST(StaticTest, PickingSamplesDoublesTheNoiseThatMeansKeep) {
  const DecimationNoise& noise = half_an_hour().noise;
  EXPECT_NEAR(noise.slow->model.white.value / milli_g, 0.1065, 0.005);
  EXPECT_NEAR(noise.picked->model.white.value / milli_g, 0.1061 * 1.977, 0.002);
}

TEST(StaticTest, TheSmoothedBiasIsWithinItsBandAndTheThesissFilterPassesTwoThirdsOfTheNoise) {
  for (const AxisTest& axis : half_an_hour().axes) {
    const BiasTracks& tracks = *axis.tracks;
    EXPECT_NEAR(tracks.filtered.mean_nis, 1.0, 0.1);
    EXPECT_GT(*tracks.smoothed.inside_95, 0.85);
    EXPECT_LT(*tracks.smoothed.rms_error_mps2, *tracks.filtered.rms_error_mps2);
    EXPECT_LT(*tracks.filtered.rms_error_mps2, 0.1 * *tracks.raw.rms_error_mps2);
    EXPECT_NEAR(*tracks.thesis.rms_error_mps2 / *tracks.raw.rms_error_mps2, 0.68, 0.03);
  }
}

TEST(StaticItems, AreFiveWithAllThatTheThesisPrints) {
  const std::vector<Item>& items = simulated_items();
  ASSERT_EQ(items.size(), 5U);
  const Item& table = item_of(items, "table 4.1");
  EXPECT_EQ(finding_of(table, "a1").thesis, 0.25);
  EXPECT_EQ(finding_of(table, "a2").thesis, -0.21);
  EXPECT_EQ(finding_of(table, "time_constant").thesis, 70.0);
  EXPECT_EQ(finding_of(item_of(items, "figure 4.6"), "inside_bounds").thesis, 0.97);
  EXPECT_EQ(finding_of(item_of(items, "figure 4.5"), "position_error_100s").ours->value, 500.0);
  EXPECT_EQ(finding_of(item_of(items, "figure 5.2"), "decimation").ours->value, 25.0);
  EXPECT_EQ(item_of(items, "figure 5.3").findings.size(), 16U);
  for (const Item& item : items) {
    EXPECT_FALSE(item.figures.empty()) << item.id;
    EXPECT_FALSE(item.ours.empty() || item.note.empty()) << item.id;
    for (const Finding& finding : item.findings)
      EXPECT_NE(finding.ours.has_value(), !finding.reason.empty()) << item.id << finding.key;
  }
}

TEST(StaticItems, SettleAtTheSumOfBothWithTheirCorrelation) {
  const Item& table = item_of(simulated_items(), "table 4.1");
  const auto& settled = *finding_of(table, "settled").ours;
  EXPECT_DOUBLE_EQ(settled.value,
                   finding_of(table, "a1").ours->value + finding_of(table, "a2").ours->value);
  EXPECT_NEAR(settled.value, 0.04, 4.0 * settled.std);
}

// --- a user's own recording ----------------------------------------------------------------------

std::vector<double> white(std::size_t samples, std::size_t index) {
  Random random(7, "still", index);
  std::vector<double> values(samples);
  for (double& value : values) value = 0.02 + milli_g * random.normal();
  return values;
}

TEST(StaticItems, OfARecordWithoutAWarmUpSayWhyThereIsNone) {
  const StaticTest test =
      analyse_static(static_record("still.csv", 100.0, 0.0,
                                   {{.name = "acc_x", .accel_mps2 = white(60'000, 0)}}),
                     {})
          .value();
  const std::vector<Item> items = static_items(test);
  const Item& table = item_of(items, "table 4.1");
  EXPECT_FALSE(finding_of(table, "a1").ours);
  EXPECT_EQ(finding_of(table, "a1").reason.rfind("No warm-up identified: ", 0), 0U);
  EXPECT_FALSE(finding_of(table, "time_constant").ours);
  EXPECT_NEAR(finding_of(table, "a2").ours->value, 0.02, 1e-4);
  const Item& tracks = item_of(items, "figure 5.3");
  EXPECT_FALSE(finding_of(tracks, "axis1_error_filter").ours);
  EXPECT_NEAR(finding_of(tracks, "axis1_bias_end").ours->value, 0.02, 1e-4);
}

// The fraction of lags within ±1.96/√n is a mean of 70 indicators of 95 %: ± 2.6 %.
TEST(StaticItems, OfWhiteResidualsHave95PercentInsideTheBounds) {
  std::vector<double> samples = white(200'000, 1);
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k] -= 0.1 * std::exp(-static_cast<double>(k) / 40.0 / 200.0);
  const StaticTest test =
      analyse_static(static_record("still.csv", 40.0, 0.0, {{.name = "y", .accel_mps2 = samples}}),
                     {})
          .value();
  EXPECT_NEAR(test.axes[0].plain->residuals->inside_bounds, 0.95, 0.03);
  EXPECT_NEAR(test.axes[0].plain->time_constant_s.value, 200.0, 1.0);
}

TEST(StaticTest, LeavesOutAnAxisThatCannotBeAnalysedAndSaysWhy) {
  const StaticTest test =
      analyse_static(static_record("still.csv", 40.0, 0.0,
                                   {{.name = "x", .accel_mps2 = std::vector<double>(4000, 1.0)},
                                    {.name = "y", .accel_mps2 = white(4000, 2)}}),
                     {})
          .value();
  EXPECT_FALSE(test.axes[0].drift);
  EXPECT_FALSE(test.axes[0].refused->message.empty());
  const std::vector<Item> items = static_items(test);
  EXPECT_EQ(item_of(items, "table 4.1").tables.front().rows[0][1].rfind("not analysed: ", 0), 0U);
}

TEST(StaticTest, RefusesARecordInWhichNoAxisCanBeAnalysed) {
  const auto constant =
      analyse_static(static_record("still.csv", 40.0, 0.0,
                                   {{.name = "x", .accel_mps2 = std::vector<double>(4000, 1.0)}}),
                     {});
  ASSERT_FALSE(constant);
  EXPECT_EQ(constant.error().message.rfind("still.csv: x: ", 0), 0U) << constant.error().message;
  const auto brief = analyse_static(
      static_record("still.csv", 40.0, 0.0, {{.name = "x", .accel_mps2 = white(8, 3)}}), {});
  ASSERT_FALSE(brief);
  EXPECT_EQ(brief.error().code, Errc::too_few_samples);
  EXPECT_FALSE(analyse_static(static_record("still.csv", 40.0, 0.0, {}), {}));
}

}  // namespace
}  // namespace proofmass::thesis::static_bias_test
