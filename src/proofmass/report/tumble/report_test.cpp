#include "proofmass/report/tumble/report.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>

#include "proofmass/report/tumble/fake.hpp"

namespace proofmass::report::tumble_report_test {
namespace {

using nlohmann::json;

constexpr double g = standard_gravity_mps2;

json document_of(const TumbleReport& report) {
  return json::parse(to_json(describe(report)));
}

TEST(TumbleReport, GivesSiAtTheTopAndTheStandardsUnitsBeside) {
  const json document = document_of(fake_tumble(fake_channel(24, 1e-5)));
  EXPECT_EQ(document["verb"], "tumble");
  EXPECT_NEAR(document["K1"]["value"].get<double>(), 0.0337, 1e-6);
  EXPECT_EQ(document["K1"]["unit"], "V/(m/s^2)");
  EXPECT_NEAR(document["in_g"]["K1"]["value"].get<double>(), 0.0337 * g, 1e-5);
  EXPECT_EQ(document["in_g"]["K1"]["unit"], "V/g");
  const double bias = document["K0"]["value"].get<double>();
  EXPECT_NEAR(document["in_g"]["K0"]["value"].get<double>(), bias / g * 1e3, 1e-9);
  EXPECT_EQ(document["in_g"]["K0"]["unit"], "mg");
  const double square = document["K2_minus_Kpp"]["value"].get<double>();
  EXPECT_NEAR(document["in_g"]["K2_minus_Kpp"]["value"].get<double>(), square * g * 1e6, 1e-9);
  EXPECT_EQ(document["in_g"]["K3"]["unit"], "ug/g^3");
  EXPECT_EQ(document["in_g"]["misalignment"]["unit"], "mrad");
  EXPECT_EQ(document["positions"].size(), 24U);
  EXPECT_EQ(document["covariance"]["of"].size(), document["covariance"]["matrix"].size());
}

TEST(TumbleReport, GivesTheReasonOfEveryNull) {
  const json document = document_of(fake_tumble(fake_channel(4, 0.0)));
  EXPECT_TRUE(document["K3"].is_null());
  EXPECT_TRUE(document["K1"]["std"].is_null());
  EXPECT_TRUE(document["drift"]["value"].is_null());
  std::string reasons;
  for (const auto& warning : document["warnings"]) reasons += warning.get<std::string>() + '\n';
  for (const char* key :
       {"K3: null: at these angles", "K1.std, K0.std, K2_minus_Kpp.std, misalignment_rad.std",
        "drift: value, std, p: null: drift during the test is unknown",
        "lack_of_fit, residual_std: null: there is no redundant position",
        "hysteresis, backlash_rad: null: ",
        "indexing: cos_rad, sin_rad, cos2_rad, sin2_rad: null: "})
    EXPECT_NE(reasons.find(key), std::string::npos) << key;
}

TEST(TumbleReport, NamesARefusedChannelAndKeepsTheOthers) {
  TumbleReport report = fake_tumble(fake_channel(12, 1e-5));
  ChannelTumble refused;
  refused.name = "acc_z";
  refused.unit = *parse_unit("V");
  refused.refused = "it does not follow the angle";
  refused.axis.phase_rad[0] = 0.0;
  report.channels.push_back(refused);
  const json document = document_of(report);
  EXPECT_EQ(document["channel"], "acc_x");
  EXPECT_EQ(document["channels"][1]["refused"], "it does not follow the angle");
  EXPECT_TRUE(document["channels"][1]["K1"].is_null());
  const auto worst = [&] {
    Severity most = Severity::info;
    for (const Note& note : tumble_notes(report)) most = std::max(most, note.severity);
    return most;
  };
  EXPECT_EQ(worst(), Severity::bad);
  // An axis parallel to the table's is normal, unless there is no other.
  report.channels[1].axis.phase_rad[0].reset();
  EXPECT_EQ(worst(), Severity::warning);
  report.channels.erase(report.channels.begin());
  EXPECT_EQ(worst(), Severity::bad);
}

TEST(TumbleReport, ConcludesWithScaleFactorAndBias) {
  const TumbleReport report = fake_tumble(fake_channel(24, 1e-5));
  const std::string words = describe(report).page.conclusion;
  EXPECT_EQ(words.find("Scale factor 0.3304"), 0U) << words;
  EXPECT_NE(words.find("mg at 0 g."), std::string::npos) << words;
}

TEST(TumbleReport, ShowsEachCoefficientInTheStandardsUnits) {
  const TumbleReport report = fake_tumble(fake_channel(24, 1e-5));
  const std::string text = to_text(describe(report));
  for (const char* words : {"K0 + Kpp g²", "K2 − Kpp", "µg/g²", "V/g", "mrad", "± "})
    EXPECT_NE(text.find(words), std::string::npos) << words << '\n' << text;
}

TEST(TumbleReport, ShowsFitResidualsAndTheSuspectOnItsPage) {
  const TumbleReport report = fake_tumble(fake_channel(24, 1e-5, 2e-3));
  const std::string page = to_html(describe(report));
  for (const char* words : {"output against angle", "residuals against angle", "± 95 %", "line 7",
                            "suspect", "Conditions of the test", "table &lt;1&gt;.csv",
                            "Contributions to the standard deviations"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

TEST(TumbleReport, WritesTheTableThatOutputAsksFor) {
  const TumbleReport report = fake_tumble(fake_channel(12, 1e-5));
  const Recording series = tumble_series(report);
  ASSERT_EQ(series.samples(), 12U);
  const Channel* output = series.find("acc_x");
  const Channel* fit = series.find("acc_x_fit");
  const Channel* residual = series.find("acc_x_residual");
  ASSERT_TRUE(output != nullptr && fit != nullptr && residual != nullptr);
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_NEAR(output->values[k], fit->values[k] + residual->values[k], 1e-12);
}

}  // namespace
}  // namespace proofmass::report::tumble_report_test
