#include "proofmass/report/tilt/report.hpp"

#include <gtest/gtest.h>

#include "proofmass/report/tilt/fake.hpp"

namespace proofmass::report::tilt_report_test {
namespace {

TEST(TiltReport, GivesANullAndItsReasonWithoutARoll) {
  const std::string json = to_json(describe(fake_tilt(false)));
  EXPECT_NE(json.find("\"roll_rad\": null"), std::string::npos);
  EXPECT_NE(json.find("roll_rad: null: the x axis is vertical"), std::string::npos);
  EXPECT_NE(json.find("\"mode\": \"still\""), std::string::npos);
  EXPECT_EQ(json.find("consistency"), std::string::npos);
  EXPECT_NE(to_text(describe(fake_tilt(false))).find("No roll: the x axis is vertical."),
            std::string::npos);
}

TEST(TiltReport, SaysTheAnglesInDegreesWithTheirStandardDeviations) {
  const TiltReport report = fake_tilt(false);
  const Document document = describe(report);
  EXPECT_EQ(document.page.conclusion, "Roll not determined, pitch 90.0 ± 0.6°, over one rest.");
  EXPECT_NE(to_text(document).find("90.0 ± 0.6°"), std::string::npos);
}

TEST(TiltReport, ShowsDownWeightedMeasurementsOnThePageAndEscapesNames) {
  const TiltReport report = fake_tilt(true);
  const std::string page = to_html(describe(report));
  EXPECT_NE(page.find("down-weighted"), std::string::npos);
  EXPECT_NE(page.find("lying &lt;1&gt;.csv"), std::string::npos);
  EXPECT_EQ(page.find("lying <1>"), std::string::npos);
  EXPECT_NE(page.find("White noise of the gyroscope"), std::string::npos);
}

TEST(TiltReport, WritesASeriesWithAColumnForEachAngle) {
  const Recording series = tilt_series(fake_tilt(true));
  EXPECT_EQ(series.samples(), 100U);
  for (const char* name : {"roll", "roll_std", "pitch", "pitch_std", "filtered_roll",
                           "filtered_pitch_std", "weight", "at_rest"})
    EXPECT_NE(series.find(name), nullptr) << name;
}

TEST(TiltReport, OfOneAxisHasItsAngleAndNoRollOrPitch) {
  const TiltReport report = fake_axis_tilt();
  const std::string json = to_json(describe(report));
  EXPECT_NE(json.find("\"mode\": \"angle\""), std::string::npos);
  EXPECT_NE(json.find("roll_rad, pitch_rad: null"), std::string::npos);
  EXPECT_EQ(describe(report).page.conclusion, "The angle is 5.7 ± 0.6° at the end.");
}

}  // namespace
}  // namespace proofmass::report::tilt_report_test
