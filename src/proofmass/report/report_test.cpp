#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/core/version.hpp"
#include "proofmass/report/budget_report.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/wheel/fake.hpp"
#include "proofmass/report/wheel/figures.hpp"

namespace proofmass::report::report_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(Document, BeginsAsEveryDocumentDoes) {
  const Json json = Json::parse(to_json({"wheel", {"a.csv"}, {"w"}}, {{"turns", 1}}));
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"proofmass", "verb", "input", "warnings", "turns"}));
  EXPECT_EQ(json["proofmass"], std::string(version()));
}

TEST(Document, HasNullForWhatIsNotFinite) {
  const Json json = Json::parse(
      to_json({"v", {}, {}},
              {{"a", std::nan("")}, {"b", INFINITY}, {"c", quantity(Uncertain{1, NAN}, "m")}}));
  EXPECT_TRUE(json["a"].is_null());
  EXPECT_TRUE(json["b"].is_null());
  EXPECT_TRUE(json["c"].is_null());
}

TEST(Document, ReadsBackBitForBit) {
  const double value = 0.1 + 0.2;
  EXPECT_EQ(Json::parse(to_json({"v", {}, {}}, {{"a", value}}))["a"].get<double>(), value);
}

TEST(Document, MendsBytesThatAreNotUtf8) {
  EXPECT_TRUE(Json::accept(to_json({"v", {"caf\xe9.csv"}, {}}, {})));
}

TEST(Scaled, KeepsAStdPositiveUnderAChangeOfSign) {
  EXPECT_EQ(scaled(Uncertain{2.0, 0.5}, -3.0)->std, 1.5);
  EXPECT_FALSE(scaled(std::nullopt, 2.0));
}

TEST(WheelConclusion, SaysTheAnswerInOneSentence) {
  EXPECT_EQ(describe(fake_report()).page.conclusion,
            "The wheel turned 79.6141 ± 0.0021 times backwards in 100 s; top speed 147 rpm.");
}

TEST(WheelConclusion, StatesThatThereIsNoAnswer) {
  WheelReport report = fake_report();
  report.solution.turns.reset();
  report.solution.peak_speed_radps.reset();
  EXPECT_EQ(describe(report).page.conclusion,
            "This recording does not determine how far the wheel turned in 100 s.");
}

TEST(WheelConclusion, GivesLessThanATurnInDegrees) {
  WheelReport report = fake_report();
  report.solution.turns = Uncertain{0.25, 0.001};
  EXPECT_EQ(describe(report).page.conclusion.substr(0, 49),
            "The wheel turned by 90.0 ± 0.4 degrees forwards ");
}

TEST(WheelJson, HasSpeedInRpmAndTheRestInSi) {
  const Json json = Json::parse(to_json(describe(fake_report())));
  EXPECT_DOUBLE_EQ(json["peak_speed_rpm"]["value"].get<double>(), -147.0);
  EXPECT_EQ(json["peak_speed_rpm"]["unit"], "rpm");
  EXPECT_DOUBLE_EQ(json["sensors"][0]["radius_m"]["value"].get<double>(), 0.1431);
  EXPECT_EQ(json["rejected_samples"], 5);
  EXPECT_DOUBLE_EQ(json["methods"]["smoother"]["turns"].get<double>(), -79.6141);
}

// Each null of the document has a warning that names it.
TEST(WheelJson, GivesAReasonForEachNull) {
  const Json json = Json::parse(to_json(describe(fake_report())));
  const std::string warnings = json["warnings"].dump();
  EXPECT_TRUE(json["sensors"][0]["bias"][1].is_null());
  EXPECT_NE(warnings.find("bias[1]"), std::string::npos);
  EXPECT_TRUE(json["sensors"][0]["skew_rad"].is_null());
  EXPECT_NE(warnings.find("skew_rad"), std::string::npos);
  EXPECT_TRUE(json["methods"]["double_integration"]["turns"].is_null());
  EXPECT_NE(warnings.find("methods.double_integration: turns, turns_std: null"), std::string::npos);
  EXPECT_TRUE(json["methods"]["atan2"]["turns_std"].is_null());
  EXPECT_NE(warnings.find("methods.atan2.turns_std"), std::string::npos);
}

TEST(WheelJson, PutsTheFirstSensorAtZeroAgainstItself) {
  const Json json = Json::parse(to_json(describe(fake_report())));
  EXPECT_EQ(json["sensors"][0]["phase_rad"]["value"], 0.0);
  EXPECT_EQ(json["sensors"][0]["clock_offset_s"]["value"], 0.0);
}

TEST(WheelHtml, ShowsConclusionSensorsAndUndeterminedFigures) {
  const WheelReport report = fake_report();
  const std::string text = to_html(describe(report));
  EXPECT_NE(text.find("79.6141 ± 0.0021 times backwards"), std::string::npos);
  EXPECT_NE(text.find("143.1\u00a0±\u00a00.8 mm"), std::string::npos);
  EXPECT_NE(text.find("are one number at one speed"), std::string::npos);
  EXPECT_NE(text.find("Figure 6."), std::string::npos);
}

TEST(WheelHtml, IsCompleteWithoutEpochs) {
  WheelReport report = fake_report();
  report.solution.series = {};
  EXPECT_NE(to_html(describe(report)).find("</html>"), std::string::npos);
}

TEST(TurnsFigure, IsNotFlattenedByADivergingIntegral) {
  estimate::WheelSolution solution = fake_report().solution;
  for (double& angle : solution.series.double_integral_angle_rad) angle *= 1e6;
  const Figure figure = turns_figure(solution);
  EXPECT_GT(*figure.y.min, -200.0);
  EXPECT_LT(*figure.y.max, 100.0);
  EXPECT_NE(figure.curves.back().label.find("off the figure: ends at"), std::string::npos);
}

// 95 % points of χ² with 2 and 4 degrees of freedom. Source: NIST/SEMATECH e-Handbook, 1.3.6.7.4.
TEST(InnovationsFigure, DrawsTheLevelOfTheChannelsUsed) {
  estimate::WheelSolution solution = fake_report().solution;
  ASSERT_EQ(innovations_figure(solution).levels.size(), 1U);
  EXPECT_NEAR(innovations_figure(solution).levels[0].y, 5.991, 5e-4);
  for (std::size_t k = 0; k < 6000; ++k) solution.series.channels_used[k] = 4;
  ASSERT_EQ(innovations_figure(solution).levels.size(), 2U);
  EXPECT_NEAR(innovations_figure(solution).levels[1].y, 9.488, 5e-4);
}

TEST(InnovationsFigure, KeepsTheWorstInnovationAndMarksTheRejected) {
  estimate::WheelSolution solution = fake_report().solution;
  solution.series.nis[7777] = 1234.0F;
  const Figure figure = innovations_figure(solution);
  EXPECT_EQ(*std::max_element(figure.curves[0].y.begin(), figure.curves[0].y.end()), 1234.0);
  EXPECT_EQ(figure.curves[1].x.size(), 39U);
}

TEST(WheelSeries, HasAColumnForEachStandardDeviationAndNoneForWhatIsAbsent) {
  WheelReport report = fake_report();
  EXPECT_EQ(wheel_series(report).channels.size(), 10U);
  report.solution.series.double_integral_angle_rad.clear();
  const Recording series = wheel_series(report);
  EXPECT_EQ(series.channels.size(), 9U);
  EXPECT_EQ(series.find("double_integral_angle"), nullptr);
  EXPECT_EQ(series.samples(), report.solution.series.time_s.size());
  EXPECT_EQ(series.find("angle_std")->unit.symbol, "rad");
}

TEST(BudgetReport, HasMilligramsBesideSiAndTheSameErrors) {
  const BudgetReport report{
      {}, {}, {{"Tactical", {0.3e-3 * standard_gravity_mps2, 0.0}, {{1.0, {0.00147, 0.0}}}}}};
  const Json json = Json::parse(to_json(describe(report)));
  EXPECT_NEAR(json["rows"][0]["bias_mg"].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(json["rows"][0]["error_m"][0]["value"], 0.00147);
  EXPECT_NE(to_text(describe(report)).find("1.5 mm"), std::string::npos);
  EXPECT_NE(to_html(describe(report)).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::report::report_test
