#include "proofmass/report/calibrate/report.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/calibrate/direction_words.hpp"
#include "proofmass/report/calibrate/fake.hpp"
#include "proofmass/report/calibrate/figures.hpp"
#include "proofmass/report/calibrate/wording.hpp"
#include "proofmass/report/json.hpp"

namespace proofmass::report::calibrate_report_test {
namespace {

using nlohmann::json;

json document_of(const CalibrateReport& report) {
  return json::parse(to_json(describe(report)));
}

std::string text_of(const CalibrateReport& report) {
  return to_text(describe(report));
}

std::string page_of(const CalibrateReport& report) {
  return to_html(describe(report));
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& one : words)
    EXPECT_NE(text.find(one), std::string::npos) << one << " in\n" << text.substr(0, 4000);
}

std::size_t bad_notes(const CalibrateReport& report) {
  return texts(calibrate_notes(report), Severity::bad).size();
}

TEST(CalibrateReport, SaysInTwoSentencesHowGoodTheSensorIsAndWhetherNoiseExplainsIt) {
  const std::string words = calibrate_conclusion(fake_calibrate_report());
  expect_words(words, {"24 positions, nine parameters: accurate to ", " at rest (68 %)",
                       "The noise explains the residuals."});
}

TEST(CalibrateReport, ReportsResidualsThatNoiseDoesNotExplain) {
  CalibrateReport report = fake_calibrate_report();
  report.fit.lack_of_fit = calibrate::LackOfFit{10.24, 1e-9, 15.0};
  expect_words(calibrate_conclusion(report),
               {"3.2 times those of the noise", "motion during the rests", "nonlinear"});
  EXPECT_EQ(texts(calibrate_notes(report), Severity::warning).size(), 1U);
  EXPECT_EQ(bad_notes(report), 0U);
}

TEST(CalibrateReport, NamesThePositionThatContradictsTheOthersAndWhatToDo) {
  CalibrateReport report = fake_suspect_report();
  const std::string left_out =
      "Position 7 (30.0–33.0 s) contradicts the others by 5.1 mg: excluded from the fit; repeat "
      "it.";
  expect_words(calibrate_conclusion(report), {left_out});
  EXPECT_EQ(bad_notes(report), 1U);
  expect_words(text_of(report), {"contradicts the others; excluded"});
  report.fit.poses[6].used = true;
  expect_words(calibrate_conclusion(report), {"kept in the fit, as requested"});
}

TEST(CalibrateReport, ReportsAnUnidentifiedBadPosition) {
  CalibrateReport report = fake_calibrate_report();
  report.fit.doubtful = {2, 7};
  expect_words(
      calibrate_conclusion(report),
      {"One of positions 3 (10.0–13.0 s) and 8 (35.0–38.0 s) is bad, and the others do not "
       "show which"});
  EXPECT_EQ(document_of(report)["doubtful"], json({3, 8}));
}

TEST(CalibrateReport, NamesTheSourceWhereNoiseIsNotWhatLimitsIt) {
  CalibrateReport report = fake_calibrate_report();
  calibrate::UncertaintyShare gravity{.source = "gravity", .type_a = false, .covariance = {}};
  gravity.covariance.setZero();
  for (Eigen::Index k = 3; k < 6; ++k) gravity.covariance(k, k) = 1e-4;
  report.fit.shares.push_back(gravity);
  report.fit.covariance += gravity.covariance;
  expect_words(calibrate_conclusion(report), {"mostly from gravity; noise alone contributes"});
}

TEST(CalibrateReport, SaysWhatIsToBeGainedByAnotherPosition) {
  CalibrateReport report = fake_calibrate_report();
  expect_words(next_pose_sentence(report), {"Next position: place it with −z straight up", "54 %"});
  report.fit.next_pose->gain = 0.03;
  expect_words(next_pose_sentence(report), {"would change little", "3 %"});
  report.fit.poses.resize(10);
  expect_words(next_pose_sentence(report), {"add several, spread over all directions"});
}

TEST(CalibrateReport, PutsADirectionIntoWords) {
  const auto words = [](double x, double y, double z) {
    return calibrate::direction_words(Eigen::Vector3d(x, y, z));
  };
  EXPECT_EQ(words(0.0, 0.0, 9.8), "+z up");
  EXPECT_EQ(words(-9.8, 0.05, 0.05), "−x up");
  EXPECT_EQ(words(std::sin(0.21), 0.0, std::cos(0.21)), "+z up, 12° to +x");
  EXPECT_EQ(words(0.6, 0.5, -1.0), "−z up, 38° to +x and +y");
  EXPECT_EQ(words(0.6, 0.1, -1.0), "−z up, 31° to +x");
  EXPECT_EQ(words(0.0, 0.0, 0.0), "");
}

TEST(CalibrateReport, GivesTheContractsFieldsInSi) {
  const json document = document_of(fake_suspect_report());
  EXPECT_EQ(document["verb"], "calibrate");
  EXPECT_EQ(document["bias"][1]["value"], -0.2);
  EXPECT_EQ(document["bias"][1]["unit"], "m/s^2");
  EXPECT_EQ(document["scale"][0]["unit"], "1");
  EXPECT_EQ(document["misalignment_rad"][2]["value"], 3e-3);
  EXPECT_EQ(document["misalignment_rad"][2]["unit"], "rad");
  EXPECT_EQ(document["covariance"].size(), 9U);
  EXPECT_EQ(document["covariance"][8].size(), 9U);
  EXPECT_EQ(document["gravity"]["std"], 4e-4);
  EXPECT_NEAR(document["residual_rms"].get<double>(), 0.05 * fake_pose_mg, 1e-12);
  const json& seventh = document["positions"][6];
  EXPECT_EQ(seventh["start_s"], 30.0);
  EXPECT_EQ(seventh["end_s"], 33.0);
  EXPECT_TRUE(seventh["suspect"].get<bool>());
  EXPECT_FALSE(seventh["used"].get<bool>());
  EXPECT_NEAR(seventh["leave_one_out"].get<double>(), 5.1 * fake_pose_mg, 1e-12);
  EXPECT_EQ(document["lack_of_fit"]["dof"], 15.0);
  EXPECT_EQ(document["next_pose"]["direction"], json({0.0, 0.0, -1.0}));
  EXPECT_EQ(document["budgets"].size(), 9U);
}

TEST(CalibrateReport, GivesStudentsIntervalOfEachFigure) {
  const json interval = document_of(fake_calibrate_report())["interval_95"]["scale"][0];
  constexpr double t_15 = 2.1314;  // 97.5 % quantile of 15 degrees of freedom
  EXPECT_NEAR(interval[0].get<double>(), 1.01 - t_15 * 2e-4, 1e-7);
  EXPECT_NEAR(interval[1].get<double>(), 1.01 + t_15 * 2e-4, 1e-7);
}

TEST(CalibrateReport, GivesTheReasonOfEveryNull) {
  std::string reasons;
  const json document = document_of(fake_bare_report());
  for (const auto& warning : document["warnings"]) reasons += warning.get<std::string>() + '\n';
  expect_words(reasons,
               {"bias[0].std, bias[1].std, bias[2].std, scale[0].std",
                "null: the noise of the means is not known and there is no redundant position\n",
                "positions[]: start_s, end_s: null (9 times): the file has no times",
                "stability: null: ", "monte_carlo: null: not requested\n",
                "cross_axis[0], cross_axis[1]: null: misalignment was not fitted\n",
                "cross_axis[2]: null: the z axis defines the frame\n"});
}

TEST(CalibrateReport, HasNoStandardDeviationWithoutNoise) {
  const CalibrateReport report = fake_bare_report();
  const json document = document_of(report);
  EXPECT_TRUE(document["bias"][0]["std"].is_null());
  EXPECT_TRUE(document["interval_95"]["bias"][0].is_null());
  EXPECT_TRUE(document["rest_accuracy"].is_null());
  EXPECT_TRUE(document["positions"][0]["start_s"].is_null());
  expect_words(calibrate_conclusion(report), {"the accuracy is not determined"});
  const std::string text = text_of(report);
  EXPECT_EQ(text.find("±"), std::string::npos);
  EXPECT_EQ(text.find("Leave-one-out"), std::string::npos);
  expect_words(page_of(report), {"U does not include it", "zero by construction"});
}

TEST(CalibrateReport, ReadsInMilligMillivoltAndMilliradian) {
  expect_words(text_of(fake_calibrate_report()),
               {"Bias x           10.197 ± 0.020 mg", "1.01000 ± 0.00020", "−2.00 ± 0.20 mrad"});
  const std::vector<CalibrationFigure> volts = calibration_figures(fake_supply_report());
  EXPECT_EQ(volts[0].printed_unit, "mV");
  EXPECT_EQ(volts[3].printed_unit, "mV/g");
  EXPECT_EQ(volts[3].unit, "V/(m/s^2)");
}

TEST(CalibrateReport, ShowsTheEffectOfTheSupply) {
  const CalibrateReport report = fake_supply_report();
  const json supply = document_of(report)["supply"];
  EXPECT_EQ(supply["points"].size(), 3U);
  EXPECT_NEAR(supply["axes"][0]["exponent"]["value"].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(supply["axes"][0]["fraction"]["value"].get<double>(), 0.5, 1e-6);
  expect_words(page_of(report), {"Effect of the supply", "Bias against the supply"});
  // 0.5 · (3.0 − 3.3) V in mV
  EXPECT_NEAR(supply_bias_figure(report).curves[0].y.front(), -150.0, 1e-6);
  EXPECT_NEAR(supply_scale_figure(report).curves[0].y.back(), 100.0 * 0.3 / 3.3, 1e-6);
}

TEST(CalibrateReport, DrawsEachPositionAndKeepsTheFarOneAtTheEdge) {
  const CalibrateReport report = fake_suspect_report();
  const Figure residuals = residual_figure(report);
  EXPECT_LT(*residuals.y.max, 0.2);
  ASSERT_EQ(residuals.callouts.size(), 1U);
  EXPECT_LT(residuals.callouts[0].y, *residuals.y.max);
  EXPECT_EQ(residuals.callouts[0].text, "7: 5.1 mg");
  const Figure map = direction_figure(report);
  std::size_t dots = 0;
  for (const Curve& curve : map.curves)
    if (curve.mark == Mark::points) dots += curve.x.size();
  EXPECT_EQ(dots, 24U);
}

TEST(CalibrateReport, HasTheCertificateOnItsPageAndEscapesNames) {
  const std::string page = page_of(fake_suspect_report());
  expect_words(page, {"turned &lt;1&gt;.csv", "Residual of each position", "Upward directions",
                      "Calibration certificate", "test sensor", "Approved by",
                      "multi-position, nine parameters", "Uncertainty budgets"});
}

TEST(CalibrateReport, SaysHowTheCheckAndNewPositionsCameOut) {
  CalibrateReport report = fake_calibrate_report();
  report.check = calibrate::MonteCarloCheck{
      .draws = 200, .agrees = false, .verdict = "200 calibrations contradict it."};
  report.validation = calibrate::Validation{{0.01, -0.01}, 0.01, 0.001, 1e-6};
  report.validation_files = {"new.csv"};
  expect_words(text_of(report),
               {"200 calibrations contradict it.", "the calibration does not hold for them"});
  EXPECT_EQ(texts(calibrate_notes(report), Severity::warning).size(), 2U);
  const json document = document_of(report);
  EXPECT_FALSE(document["monte_carlo"]["agrees"].get<bool>());
  EXPECT_EQ(document["validation"]["positions"], 2);
}

TEST(CalibrateReport, WritesTheTableThatOutputAsksFor) {
  const Recording series = calibrate_series(fake_suspect_report());
  ASSERT_EQ(series.samples(), 24U);
  const Channel* suspect = series.find("suspect");
  const Channel* start = series.find("start");
  ASSERT_TRUE(suspect != nullptr && start != nullptr && series.find("force_z") != nullptr);
  EXPECT_EQ(suspect->values[6], 1.0);
  EXPECT_EQ(start->values[6], 30.0);
  EXPECT_TRUE(std::isnan(calibrate_series(fake_bare_report()).find("start")->values[0]));
}

}  // namespace
}  // namespace proofmass::report::calibrate_report_test
