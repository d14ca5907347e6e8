#include "proofmass/report/sensor/report.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/schema_test_support.hpp"
#include "proofmass/report/sensor/diff_wording.hpp"

namespace proofmass::report::sensor_report_test {
namespace {

using Json = nlohmann::ordered_json;
using sensor::make_axis_figures;
using sensor::make_figure;
using sensor::SensorModel;

SensorModel calibrated(double x_bias_mps2) {
  SensorModel model;
  model.name = "ADXL335 <rim>";
  model.serial = "17";
  model.date = "2026-11-21";
  model.calibration.bias = make_axis_figures({x_bias_mps2, -0.2, 0.3}, "m/s^2", "tumble");
  model.calibration.scale = make_axis_figures({1.01, 0.99, 1.0}, "1", "tumble");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    model.calibration.bias[axis]->std = 0.003;
    model.calibration.scale[axis]->std = 2e-4;
  }
  model.calibration.gravity = make_figure(9.81, "m/s^2", "place");
  model.noise.white = make_axis_figures({106, 106, 212}, "ug/sqrt(Hz)", "static.csv");
  return model;
}

SensorDiff diff_of(const SensorModel& before, const SensorModel& after) {
  return {"a/old.toml", "b/new.toml", {}, sensor::compare(before, after)};
}

/// The calibration of another day: the same figures with another origin.
SensorModel again(double x_bias_mps2) {
  SensorModel model = calibrated(x_bias_mps2);
  for (std::size_t axis = 0; axis < 3; ++axis)
    model.calibration.bias[axis]->origin = model.calibration.scale[axis]->origin = "tumble 2";
  return model;
}

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

bool says(const std::vector<std::string>& sentences, std::string_view part) {
  return std::ranges::any_of(sentences, [&](const std::string& s) { return has(s, part); });
}

TEST(SensorShow, HasEachFigureWithUnitStdAndOrigin) {
  const std::string text = to_text(describe(SensorShow{"s.toml", calibrated(0.1), {}}));
  EXPECT_TRUE(has(text, "Sensor         ADXL335 <rim>\n  Serial number  17\n")) << text;
  EXPECT_TRUE(
      has(text, "calibration (7 figures), noise (3 figures); nothing on drift, electrical"));
  EXPECT_TRUE(has(text, "bias x   0.1000 ± 0.0030")) << text;
  EXPECT_TRUE(has(text, "212    ug/√Hz  not stated  static.csv")) << text;
  EXPECT_TRUE(has(text, "tumble"));
}

TEST(SensorShow, NamesTheStrongestCorrelation) {
  SensorModel model = calibrated(0.1);
  auto& C = model.calibration.covariance.emplace();
  for (auto& row : C) row.fill(0.0);
  C[0][0] = 9e-6;
  C[3][3] = 4e-8;
  C[0][3] = C[3][0] = -0.5 * 3e-3 * 2e-4;
  EXPECT_TRUE(has(to_text(describe(SensorShow{"s.toml", model, {}})),
                  "most correlated are bias x and scale x, −0.50"));
}

TEST(SensorShow, ItsDocumentIsInSiAndSaysWhatIsWritten) {
  const Json document = Json::parse(to_json(describe(SensorShow{"s.toml", calibrated(0.1), {}})));
  EXPECT_EQ(document["action"], "show");
  EXPECT_EQ(document["serial"], "17");
  const Json& white = document["figures"].back();
  EXPECT_EQ(white["key"], "white");
  EXPECT_EQ(white["axis"], "z");
  EXPECT_NEAR(white["value"].get<double>(), 212e-6 * 9.80665, 1e-15);
  EXPECT_EQ(white["unit"], "m/s^2/sqrt(Hz)");
  EXPECT_EQ(white["written_value"], 212.0);
  EXPECT_TRUE(white["std"].is_null());
  EXPECT_TRUE(document["covariance"].is_null());
  EXPECT_EQ(document["warnings"].size(), 2U);
}

TEST(SensorShow, OfAnEmptyFileSaysSo) {
  EXPECT_TRUE(has(to_text(describe(SensorShow{"s.toml", {}, {}})), "The file has no figures."));
  EXPECT_TRUE(has(to_html(describe(SensorShow{"s.toml", {}, {}})), "The file has no figures."));
}

TEST(SensorShow, ItsPageEscapesTheName) {
  const std::string page = to_html(describe(SensorShow{"s.toml", calibrated(0.1), {}}));
  EXPECT_TRUE(has(page, "ADXL335 &lt;rim&gt;"));
  EXPECT_FALSE(has(page, "<rim>"));
}

TEST(SensorDiff, SaysWhatChangedAndWhatItWouldDo) {
  const SensorDiff diff = diff_of(calibrated(0.1), again(0.15));
  const auto findings = sensor_diff_findings(diff);
  EXPECT_EQ(findings[0], "The calibration has changed by more than its uncertainty.");
  EXPECT_TRUE(says(findings, "Changed by more than their uncertainty: calibration.bias x."));
  // 0.05 m/s² of bias over a scale of 1.01 are 5.05 mg; √2 · 0.003/1.01 m/s² are 0.43 mg.
  EXPECT_TRUE(says(findings, "up to 5.0 ± 0.4 mg (0.050 ± 0.004 m/s²) at 1 g")) << findings[2];
  EXPECT_TRUE(says(findings, "in 95 % of cases"));
  EXPECT_TRUE(
      says(findings, "No test of the calibration as a whole: no covariance in OLD and NEW"));
}

TEST(SensorDiff, StatesThatNothingChanged) {
  const auto findings = sensor_diff_findings(diff_of(calibrated(0.1), again(0.103)));
  EXPECT_EQ(findings[0], "The calibration is the same within its uncertainty.");
  EXPECT_FALSE(says(findings, "Changed"));
  const auto itself = sensor_diff_findings(diff_of(calibrated(0.1), calibrated(0.1)));
  ASSERT_EQ(itself.size(), 1U);
  EXPECT_EQ(itself[0], "The calibration is the same in both files.");
  EXPECT_EQ(sensor_diff_findings(diff_of({}, {}))[0], "Neither file has a calibration.");
}

TEST(SensorDiff, SaysWhatIsUndetermined) {
  SensorModel other = again(0.1);
  other.noise.white[0]->value = 110;
  const SensorDiff diff = diff_of(calibrated(0.1), other);
  EXPECT_TRUE(says(sensor_diff_findings(diff), "Undetermined: noise.white x."));
  EXPECT_TRUE(has(to_text(describe(diff)), "undetermined: no uncertainty in OLD and NEW"));
}

TEST(SensorDiff, ShowsBothFilesInTheNewOnesUnit) {
  SensorModel other = again(0.1);
  other.calibration.bias[0] = make_figure(120.0, "mm/s^2", "tumble 2");
  other.calibration.bias[0]->std = 3.0;
  EXPECT_TRUE(has(to_text(describe(diff_of(calibrated(0.1), other))), "100.0 ± 3.0"));
}

TEST(SensorDiff, ItsDocumentHasFiguresEffectAndAReasonForEveryNull) {
  const Json document = Json::parse(to_json(describe(diff_of(calibrated(0.1), again(0.15)))));
  EXPECT_EQ(document["action"], "diff");
  EXPECT_EQ(document["verdict"], "changed");
  EXPECT_EQ(document["input"], (Json{"a/old.toml", "b/new.toml"}));
  EXPECT_EQ(document["tests"], 6);
  const Json& bias = document["figures"][0];
  EXPECT_EQ(bias["verdict"], "changed");
  EXPECT_NEAR(bias["change"]["value"].get<double>(), 0.05, 1e-12);
  EXPECT_NEAR(bias["in_std"].get<double>(), 0.05 / (0.003 * std::sqrt(2.0)), 1e-9);
  EXPECT_TRUE(document["joint"].is_null());
  EXPECT_NEAR(document["effect"]["error"]["value"].get<double>(), 0.05 / 1.01, 1e-9);
  EXPECT_NEAR(document["effect"]["error_mg"]["value"].get<double>(), 5.048, 1e-3);
  EXPECT_GT(document["effect"]["angle_deg"]["by_chance_95"].get<double>(), 0.0);
  EXPECT_TRUE(says(document["warnings"].get<std::vector<std::string>>(), "joint: null: no covar"));
}

TEST(SensorDiff, ItsPageHasTheFigureWhereThereIsSomethingToDraw) {
  EXPECT_TRUE(has(to_html(describe(diff_of(calibrated(0.1), again(0.15)))), "<svg"));
  EXPECT_FALSE(has(to_html(describe(diff_of(calibrated(0.1), calibrated(0.1)))), "<svg"));
}

/// Every entry that a calibration can have.
SensorModel full(double x_bias_mps2) {
  SensorModel model = again(x_bias_mps2);
  model.calibration.misalignment = make_axis_figures({0.01, 0.02, 0.03}, "rad", "tumble 2");
  for (auto& figure : model.calibration.misalignment) figure->std = 1e-4;
  model.calibration.dof = make_figure(20.0, "1", "tumble 2");
  auto& C = model.calibration.covariance.emplace();
  for (auto& row : C) row.fill(0.0);
  for (std::size_t k = 0; k < 9; ++k) C[k][k] = k < 3 ? 9e-6 : k < 6 ? 4e-8 : 1e-8;
  return model;
}

TEST(Schemas, Sensor) {
  SensorModel other = calibrated(0.1);
  other.calibration.bias[0].reset();
  other.calibration.bias[1]->std.reset();
  other.noise.white[0]->value = 110.0;
  expect_schema_of_kinds(
      "A sensor file as it is (show), compared with another (diff), or in another format (export).",
      {{describe(SensorShow{"s.toml", full(0.1), {}}), describe(SensorShow{"s.toml", other, {}})},
       {describe(diff_of(full(0.1), full(0.2))), describe(diff_of(full(0.1), calibrated(0.1))),
        describe(diff_of(other, again(0.1)))},
       {describe(SensorExport{"s.toml", "imu-yaml", "s.yaml", "text", {}})}});
}

TEST(SensorExport, WithoutAFileSaysThatTheDocumentHasTheText) {
  const Json document =
      Json::parse(to_json(describe(SensorExport{"s.toml", "c-header", {}, "text", {}})));
  EXPECT_TRUE(document["output"].is_null());
  EXPECT_TRUE(has(document["warnings"][0].get<std::string>(), "output: null: no --output"));
  EXPECT_EQ(document["text"], "text");
}

}  // namespace
}  // namespace proofmass::report::sensor_report_test
