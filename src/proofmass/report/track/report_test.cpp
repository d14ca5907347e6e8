#include "proofmass/report/track/report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/track/fake.hpp"
#include "proofmass/report/track/wording.hpp"

namespace proofmass::report::track_report_test {
namespace {

using nlohmann::json;

bool tells(const json& document, const std::string& words) {
  for (const std::string text : document["warnings"])
    if (text.find(words) != std::string::npos) return true;
  return false;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(TrackJson, HoldsWhatScriptsRelyOn) {
  const json document = json::parse(to_json(describe(fake_track())));
  EXPECT_EQ(document["verb"], "track");
  EXPECT_EQ(document["methods"]["smoother"]["displacement_m"], 0.2);
  EXPECT_EQ(document["methods"]["smoother"]["std_m"], 0.002);
  EXPECT_EQ(document["methods"]["smoother"]["path_m"], 2.6);
  EXPECT_EQ(document["methods"]["smoother"]["peak_m"], 0.4);
  EXPECT_EQ(document["methods"]["kalman"]["displacement_m"], 0.254);
  EXPECT_EQ(document["methods"]["double_integration"]["displacement_m"], 6.68);
  EXPECT_EQ(document["rests"].size(), 5U);
  EXPECT_DOUBLE_EQ(document["rests"][1]["start_s"], 4.0);
  EXPECT_EQ(document["strokes"].size(), 4U);
  EXPECT_DOUBLE_EQ(document["strokes"][0]["length_m"], 0.402);
  EXPECT_EQ(document["axis"], (json{0.0, 0.6, 0.8}));
  for (const char* key : {"nis", "nis_lower", "nis_upper"})
    EXPECT_TRUE(document["consistency"][key].is_number()) << key;
}

TEST(TrackJson, HasTheModelAndEachSensorAlone) {
  const json one = json::parse(to_json(describe(fake_track())));
  EXPECT_EQ(one["model"], "inertial");
  EXPECT_TRUE(one["jerk_psd"].is_null());
  EXPECT_TRUE(one["fused"].is_null());
  EXPECT_TRUE(tells(one, "jerk_psd: null"));
  EXPECT_TRUE(tells(one, "fused: null"));
  const json two = json::parse(to_json(describe(fake_fused())));
  EXPECT_EQ(two["model"], "fused");
  EXPECT_EQ(two["jerk_psd"], (json{{"value", 12.0}, {"std", 0.5}, {"unit", "m^2/s^5"}}));
  EXPECT_EQ(two["fused"]["variance_gain"], 2.1);
  EXPECT_EQ(two["fused"]["sensors"][1]["name"], "acc<2>");
  EXPECT_EQ(two["fused"]["sensors"][1]["displacement_m"], 0.198);
  EXPECT_EQ(two["fused"]["sensors"][0]["bias_mps2"], 0.02);
}

TEST(TrackText, HasEachFusedSensorAlone) {
  EXPECT_EQ(to_text(describe(fake_track())).find("alone"), std::string::npos);
  const std::string text = to_text(describe(fake_fused()));
  EXPECT_NE(text.find("acc alone"), std::string::npos);
  EXPECT_NE(text.find("variance 2.1 times smaller"), std::string::npos);
  EXPECT_NE(to_html(describe(fake_fused())).find("acc&lt;2&gt; alone"), std::string::npos);
}

TEST(TrackJson, TheIntervalIsThatOfTheMethod) {
  const json interval =
      json::parse(to_json(describe(fake_track())))["methods"]["smoother"]["interval_95_m"];
  EXPECT_NEAR(interval[0].get<double>(), 0.1952, 1e-12);
  EXPECT_NEAR(interval[1].get<double>(), 0.2048, 1e-12);
}

TEST(TrackJson, AStrokeOneWayHasNoTurnAndAWarningSaysSo) {
  const json document = json::parse(to_json(describe(fake_track())));
  EXPECT_EQ(document["strokes"][0]["kind"], "there_and_back");
  EXPECT_EQ(document["strokes"][3]["kind"], "one_way");
  EXPECT_TRUE(document["strokes"][3]["back_m"].is_null());
  EXPECT_TRUE(tells(document, "strokes[3]: turn_s, back_m: null: a stroke one way does not turn"));
}

TEST(TrackJson, OfJerkItHasNoFigureAndSaysWhy) {
  const json document = json::parse(to_json(describe(fake_jerk())));
  for (const char* method : {"double_integration", "kalman", "smoother"})
    for (const auto& figure : document["methods"][method]) EXPECT_TRUE(figure.is_null());
  EXPECT_TRUE(document["suspected_jerk"]);
  EXPECT_TRUE(document["stroke_summary"]["median_length_m"].is_null());
  EXPECT_TRUE(tells(document, "methods.smoother: displacement_m, std_m"));
  EXPECT_TRUE(tells(document, "jerk"));
}

TEST(TrackText, HasTheErrorBudgetAfterTheConclusion) {
  const std::string text = to_text(describe(fake_track()));
  EXPECT_EQ(text.find("After 18 s the displacement is"), 0U) << text;
  EXPECT_NE(text.find("Error of plain double integration 900 mm at the end"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');
}

TEST(TrackText, OfJerkItGivesNoLength) {
  const std::string text = to_text(describe(fake_jerk()));
  EXPECT_NE(text.find("is not determined: the data behave like"), std::string::npos) << text;
  EXPECT_EQ(text.find("Smoother"), std::string::npos) << text;
}

TEST(TrackConclusion, SaysWhereItEndedAndTheStrokes) {
  const std::string text = describe(fake_track()).page.conclusion;
  EXPECT_NE(
      text.find("After 18 s the displacement is 0.2000 ± 0.0020 m along (0.000, 0.600, 0.800)"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("3 strokes there and back and 1 one way, median length 0.404 ± 0.004 m"),
            std::string::npos)
      << text;
}

TEST(StrokeSummary, IsTheMedianWithTheMedianStd) {
  const auto summary = summary_of(fake_track().solution.strokes);
  ASSERT_TRUE(summary.has_value());
  EXPECT_EQ(summary->count, 4U);
  EXPECT_EQ(summary->there_and_back, 3U);
  EXPECT_DOUBLE_EQ(summary->median_length_m.value, 0.5 * (0.402 + 0.406));
  EXPECT_DOUBLE_EQ(summary->median_length_m.std, 0.004);
  EXPECT_FALSE(summary_of({}).has_value());
}

TEST(TrackHtml, HasItsPlots) {
  const std::string page = to_html(describe(fake_track()));
  EXPECT_EQ(count_of(page, "</svg>"), 4U);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_NE(page.find("stroke &lt;1&gt;.csv"), std::string::npos);
  EXPECT_NE(page.find("off the figure: ends at 6.7"), std::string::npos);
}

TEST(TrackHtml, OfJerkShowsTheReadingsAlone) {
  EXPECT_EQ(count_of(to_html(describe(fake_jerk())), "</svg>"), 1U);
}

TEST(TrackSeries, HasARowForEachSampleAndOfJerkTheReadingsAlone) {
  const Recording series = track_series(fake_track());
  EXPECT_EQ(series.samples(), 1800U);
  EXPECT_NE(series.find("position_std"), nullptr);
  EXPECT_EQ(track_series(fake_jerk()).find("position"), nullptr);
  EXPECT_NE(track_series(fake_jerk()).find("accel"), nullptr);
}

TEST(LengthWithStd, IsInMillimetresWhereBothAreSmall) {
  EXPECT_EQ(length_with_std({0.0123, 0.0004}), "12.3 ± 0.4 mm");
  EXPECT_EQ(length_with_std({0.441, 0.012}), "0.441 ± 0.012 m");
  EXPECT_EQ(length_with_std({0.001, 0.2}), "0.00 ± 0.20 m");
}

}  // namespace
}  // namespace proofmass::report::track_report_test
