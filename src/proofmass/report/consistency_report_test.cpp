#include "proofmass/report/consistency_report.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"

namespace proofmass::report::consistency_report_test {
namespace {

using estimate::ConsistencyCheck;

estimate::Consistency scattered(double first, double second, double outlier = 0.0) {
  ConsistencyCheck check({.channels = {"a/x.csv: acc_x", "a/x.csv: acc_y"}, .rate_hz = 10.0});
  Random random(1, "scattered");
  for (int k = 0; k < 4000; ++k) {
    check.add(0, first * random.normal() + (k % 200 == 0 ? outlier : 0.0), 1.0);
    check.add(1, second * random.normal(), 1.0);
  }
  return check.judge();
}

const NoiseNames names{.measurement = "accel_std", .process = "jerk_std", .slow = "bias_walk"};

TEST(ConsistencyReport, SaysOneSentenceAndWhatToMove) {
  EXPECT_EQ(consistency_conclusion(scattered(1.0, 1.0), names), "The filter is consistent.");
  EXPECT_EQ(
      consistency_conclusion(scattered(1.6, 1.6), names),
      "The innovations have 1.6 times their predicted standard deviation: raise accel_std and "
      "jerk_std by a factor of 1.6.");
  EXPECT_EQ(
      consistency_conclusion(scattered(0.5, 0.5), names),
      "The innovations have 0.50 times their predicted standard deviation: lower accel_std and "
      "jerk_std by a factor of 2.0.");
  EXPECT_EQ(
      consistency_conclusion(scattered(1.0, 2.0), names),
      "x.csv: acc_y: the innovations have 2.0 times their predicted standard deviation: raise "
      "accel_std and jerk_std by a factor of 2.0.");
  EXPECT_EQ(
      consistency_conclusion(scattered(1.0, 1.0, 30.0), names),
      "x.csv: acc_x: the innovations have 2.4 times their predicted standard deviation: a few "
      "measurements are outliers; reject them with a gate.");
}

TEST(ConsistencyReport, SaysOfColourWhetherTheFilterLagsOrFollowsTheNoise) {
  ConsistencyCheck slow({.channels = {"z"}}), fast({.channels = {"z"}});
  Random random(2, "colour");
  double held = 0.0, last = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double w = random.normal();
    held = 0.8 * held + 0.6 * w;
    slow.add(0, held, 1.0);
    fast.add(0, std::sqrt(0.5) * (w - last), 1.0);
    last = w;
  }
  const std::string lags = consistency_conclusion(slow.judge(), names);
  EXPECT_NE(lags.find("the filter responds too slowly; raise jerk_std"), std::string::npos) << lags;
  const std::string nervous = consistency_conclusion(fast.judge(), names);
  EXPECT_NE(nervous.find("the filter follows the noise; lower jerk_std"), std::string::npos)
      << nervous;
}

TEST(ConsistencyReport, EveryNullHasItsReason) {
  const auto nothing = ConsistencyCheck({.channels = {"z"}}).judge();
  const std::string text = json_text(json_of({consistency_field(nothing)}));
  EXPECT_NE(text.find("\"nis\": null"), std::string::npos);
  const std::vector<std::string> reasons = reasons_for_nulls({consistency_field(nothing)});
  ASSERT_EQ(reasons.size(), 2U);
  EXPECT_EQ(
      reasons[0],
      "consistency: nis, nis_lower, nis_upper, std_factor, inside_95, lag_one, lag_one_bound: "
      "null: there is no innovation");
  EXPECT_TRUE(reasons_for_nulls({consistency_field(scattered(1.0, 1.0))}).empty());
  EXPECT_EQ(consistency_conclusion(nothing),
            "0 innovations are too few to judge the consistency of the filter.");
}

TEST(ConsistencyReport, DocumentHasTheFiguresOfAllAndOfEachChannel) {
  const std::string text = json_text(json_of({consistency_field(scattered(1.0, 2.0), names)}));
  for (const char* piece :
       {"\"nis_lower\"", "\"nis_upper\"", "\"verdict\": \"overconfident\"",
        "\"verdict_of\": \"a/x.csv: acc_y\"", "\"what\": \"both_noises\"", "\"stretches\": [",
        "\"name\": \"a/x.csv: acc_x\"", "\"verdict\": \"consistent\""})
    EXPECT_NE(text.find(piece), std::string::npos) << piece;
}

TEST(ConsistencyReport, PageHasTheVerdictAndTheChannels) {
  const Section section = consistency_section(scattered(1.0, 1.0));
  EXPECT_EQ(section.paragraphs.front(), "The filter is consistent.");
  ASSERT_EQ(section.tables.size(), 2U);
  EXPECT_EQ(section.tables[0].rows.size(), 3U);
  EXPECT_EQ(section.tables[0].rows[0][0], "x.csv: acc_x");
  EXPECT_EQ(section.tables[1].rows[0][0], "0.2 s");
}

}  // namespace
}  // namespace proofmass::report::consistency_report_test
