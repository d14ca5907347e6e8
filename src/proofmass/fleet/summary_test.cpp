#include "proofmass/fleet/summary.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"

namespace proofmass::fleet::summary_test {
namespace {

namespace fs = std::filesystem;

TEST(ParseLimit, ReadsAFigureASideAndABound) {
  const auto limit = parse_limit("white<=2e-3");
  ASSERT_TRUE(limit);
  EXPECT_EQ(limit->figure, "white");
  EXPECT_TRUE(limit->is_upper);
  EXPECT_EQ(limit->bound, 2e-3);
  EXPECT_FALSE(parse_limit("time_constant_s>10").value().is_upper);
  for (const char* bad : {"white", "<2", "white<", "white<x"})
    EXPECT_FALSE(parse_limit(bad)) << bad;
}

// y = 2 + 0.5 x + level: the slope is exact whatever the levels are.
TEST(FitTrend, FindsTheSlopeWithinSensorsOfDifferentLevels) {
  std::vector<TrendPoint> points;
  for (std::size_t sensor = 0; sensor < 4; ++sensor)
    for (int k = 0; k < 5; ++k) {
      const double wobble = k % 2 == 0 ? 1e-3 : -1e-3;
      points.push_back(
          {sensor, 1.0 * k, 2.0 + 0.5 * k - 10.0 * static_cast<double>(sensor) + wobble});
    }
  const auto trend = fit_trend(points);
  ASSERT_TRUE(trend);
  EXPECT_TRUE(trend->within_sensors);
  EXPECT_NEAR(trend->slope.value, 0.5, 1e-9);
  EXPECT_LT(trend->p, 1e-10);
}

TEST(FitTrend, OfSensorsSeenOnceIsOneBetweenThem) {
  std::vector<TrendPoint> points;
  for (std::size_t k = 0; k < 8; ++k)
    points.push_back(
        {k, static_cast<double>(k), static_cast<double>(k) + (k % 2 == 0 ? 0.1 : 0.0)});
  const auto trend = fit_trend(points);
  ASSERT_TRUE(trend);
  EXPECT_FALSE(trend->within_sensors);
}

TEST(FitTrend, IsNoneWhereTheCauseDoesNotVary) {
  EXPECT_FALSE(
      fit_trend({{0, 20.0, 1.0}, {0, 20.0, 2.0}, {0, 20.0, 3.0}, {0, 20.0, 4.0}, {0, 20.0, 5.0}}));
}

class FleetSummary : public testing::Test {
 protected:
  // 20 sensors with five recordings each; the figure rises by 0.02 a kelvin.
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("proofmass_summary_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    Random random(10, "summary");
    auto opened = Results::open(folder_, {});
    ASSERT_TRUE(opened);
    Results results = std::move(opened).value();
    for (int sensor = 0; sensor < 20; ++sensor) {
      const double level = 1.0 + 0.1 * random.normal() + (sensor == 7 ? 3.0 : 0.0);
      for (int k = 0; k < 5; ++k) {
        const double temperature_c = 20.0 + k;
        Entry one;
        one.verb = "noise";
        one.path = fmt::format("s{}-{}.csv", sensor, k);
        one.document = "documents/" + one.path + ".json";
        one.columns = {{"sensor", fmt::format("S{:02}", sensor)},
                       {"temperature", fmt::format("{}", temperature_c)},
                       {"date", fmt::format("2026-01-{:02}", 1 + (sensor * 7 + k * 5) % 28)}};
        one.rows = {{{"channel", std::string("x")},
                     {"white", level + 0.02 * (temperature_c - 20.0) + 0.005 * random.normal()},
                     {"white_std", 0.005},
                     {"white_verdict",
                      std::string(k == 4 && sensor == 0 ? "not_observable" : "identified")}}};
        ASSERT_TRUE(results.append(one));
      }
    }
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(FleetSummary, NamesTheSensorOutOfFamilyAndNoOther) {
  const auto summary = summarise(folder_, {});
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->recordings, 100U);
  ASSERT_EQ(summary->figures.size(), 1U);
  const FigureSummary& figure = summary->figures[0];
  EXPECT_EQ(figure.not_identified, 1U);
  ASSERT_EQ(figure.outliers.size(), 1U);
  EXPECT_EQ(summary->sensors[figure.outliers[0].sensor], "S07");
  ASSERT_TRUE(figure.type);
  EXPECT_EQ(figure.type->sensors, 19U);
  EXPECT_LT(figure.type->between_95.lower, 0.1);
  EXPECT_GT(figure.type->between_95.upper, 0.1);
}

TEST_F(FleetSummary, FindsWhatFollowsTheTemperatureAndNothingThatFollowsTheDate) {
  const auto summary = summarise(folder_, {});
  ASSERT_TRUE(summary);
  const FigureSummary& figure = summary->figures[0];
  ASSERT_TRUE(figure.per_kelvin && figure.per_day);
  EXPECT_NEAR(figure.per_kelvin->slope.value, 0.02, 3.0 * figure.per_kelvin->slope.std);
  EXPECT_LT(figure.per_kelvin_adjusted_p, 1e-6);
}

// Wilson's interval for 19 of 20: 0.764 to 0.991 (R. G. Newcombe, Statistics in Medicine 17 (1998)
// 857, method 3).
TEST_F(FleetSummary, CountsTheSensorsWithinALimit) {
  const auto summary = summarise(folder_, {.limits = {parse_limit("white<2").value()}});
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->figures[0].yields.size(), 1U);
  const Yield& yield = summary->figures[0].yields[0];
  EXPECT_EQ(yield.within, 19U);
  EXPECT_EQ(yield.sensors, 20U);
  EXPECT_NEAR(yield.share_95.lower, 0.764, 1e-3);
  EXPECT_NEAR(yield.share_95.upper, 0.991, 1e-3);
  ASSERT_EQ(yield.failing.size(), 1U);
  EXPECT_EQ(summary->sensors[yield.failing[0]], "S07");
}

TEST_F(FleetSummary, RefusesALimitOfAFigureThatIsNotThere) {
  const auto summary = summarise(folder_, {.limits = {parse_limit("whit<2").value()}});
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().message, "limit whit<2: there is no figure whit: there are white");
}

TEST_F(FleetSummary, LeadsFromAnOutlierToItsRecordings) {
  const auto summary = summarise(folder_, {});
  ASSERT_TRUE(summary);
  const std::string page = report::to_html(describe(*summary, "../results/"));
  for (int k = 0; k < 5; ++k)
    EXPECT_NE(page.find(fmt::format("<a href=\"../results/documents/s7-{}.csv.json\">", k)),
              std::string::npos);
  EXPECT_EQ(page.find("documents/s6-0.csv.json"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::fleet::summary_test
