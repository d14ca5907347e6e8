#include "proofmass/report/tune/report.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/tune/fake.hpp"
#include "proofmass/report/tune/wording.hpp"

namespace proofmass::report::tune_report_test {
namespace {

TEST(TuneUnit, IsThatOfTheFilter) {
  const Unit accel = *parse_unit("m/s^2"), metre = *parse_unit("m");
  EXPECT_EQ(tune_unit(accel, 2, 0.0), "m^2/s^4");
  EXPECT_EQ(tune_unit(accel, 2, -1.0), "m^2/s^5");
  EXPECT_EQ(tune_unit(accel, 1, 0.5), "m/s^2/sqrt(Hz)");
  EXPECT_EQ(tune_unit(accel, 1, -0.5), "m/s^2/sqrt(s)");
  EXPECT_EQ(tune_unit(metre, 2, -5.0), "m^2/s^5");
  EXPECT_EQ(tune_unit(metre, 2, 0.0), "m^2");
  EXPECT_EQ(tune_unit({Quantity::counts, 1.0, 0.0, "counts"}, 2, -1.0), "counts^2/s");
  EXPECT_EQ(tune_unit(*parse_unit("rad/s"), 2, -1.0), "(rad/s)^2/s");
  EXPECT_EQ(tune_unit({Quantity::unknown, 1.0, 0.0, "1"}, 2, 0.0), "1");
  EXPECT_EQ(tune_unit(accel, 0, 1.0), "s");
}

TEST(TuneJson, HoldsTheParametersAndTheFilter) {
  const auto json = nlohmann::json::parse(to_json(describe(fake_tuned(0.01))));
  EXPECT_EQ(json["verb"], "tune");
  ASSERT_EQ(json["parameters"].size(), 2U);
  EXPECT_EQ(json["parameters"][0]["name"], "white");
  EXPECT_GT(json["parameters"][0]["std"].get<double>(), 0.0);
  EXPECT_TRUE(json["log_likelihood"].is_number());
  const double white = json["parameters"][0]["value"];
  EXPECT_NEAR(json["channels"][0]["filter"]["R"].get<double>(), white * white * 100.0, 1e-12);
  EXPECT_EQ(json["study"][0]["cases"][0]["settling_s"].size(), 3U);
}

TEST(TuneJson, EveryNullHasItsReason) {
  const auto json = nlohmann::json::parse(to_json(describe(fake_tuned(0.0))));
  EXPECT_TRUE(json["parameters"][1]["value"].is_null());
  bool found = false;
  for (const std::string text : json["warnings"])
    found = found || text.find("(random_walk): value, std: null: not distinguishable from zero") !=
                         std::string::npos;
  EXPECT_TRUE(found);
}

TEST(TuneText, SaysWhatIsNotIdentifiable) {
  const std::string text = to_text(describe(fake_tuned(0.0)));
  EXPECT_NE(text.find("not distinguishable from zero, below"), std::string::npos) << text;
  EXPECT_NE(text.find("white"), std::string::npos);
}

TEST(TuneHtml, IsOnePageWithTheStudy) {
  const std::string page = to_html(describe(fake_tuned(0.01)));
  EXPECT_NE(page.find("gain against time"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(TuneSeries, HasARowForEachSample) {
  const Recording series = tune_series(fake_tuned(0.01));
  EXPECT_EQ(series.samples(), 2000U);
  ASSERT_EQ(series.channels.size(), 2U);
  EXPECT_TRUE(std::isnan(series.channels[0].values[0]));
}

}  // namespace
}  // namespace proofmass::report::tune_report_test
