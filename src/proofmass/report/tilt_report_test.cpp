#include "proofmass/report/tilt_report.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace proofmass::report::tilt_report_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// One rest of a hundred samples with no roll, then as a moving base if asked for.
TiltReport fake_tilt(bool moving) {
  TiltReport report;
  report.inputs = {"lying <1>.csv"};
  report.gravity_mps2 = {9.80665, 0.015};
  estimate::TiltSolution solution;
  solution.samples = 100;
  solution.axes = 3;
  solution.moving = moving;
  solution.final.why_no_roll = "the x axis stands upright";
  solution.final.pitch_rad = Uncertain{std::numbers::pi / 2, 0.01};
  for (int k = 0; k < 100; ++k) {
    solution.series.time_s.push_back(0.01 * k);
    for (auto* values : {&solution.series.pitch_rad, &solution.series.filtered_pitch_rad})
      values->push_back(1.5 + 1e-3 * k);
    for (auto* values : {&solution.series.pitch_std_rad, &solution.series.filtered_pitch_std_rad})
      values->push_back(0.01);
    for (auto* values :
         {&solution.series.roll_rad, &solution.series.roll_std_rad,
          &solution.series.filtered_roll_rad, &solution.series.filtered_roll_std_rad})
      values->push_back(none);
    solution.series.up[0].push_back(-1.0);
    solution.series.up[1].push_back(0.0);
    solution.series.up[2].push_back(0.0);
    solution.series.weight.push_back(k == 50 ? 0.1F : 1.0F);
    solution.series.resting.push_back(1);
  }
  solution.rests.push_back({.first = 0, .last = 99});
  solution.rests.back().angles = solution.final;
  solution.notes = {{Severity::warning, "nothing says how well it is calibrated"}};
  if (moving) {
    solution.motion = estimate::TiltMotion{.gyroscope = true, .drive = 1e-3};
    estimate::ConsistencyCheck check({.channels = {"x", "y", "z"}, .rate_hz = 100.0});
    for (int k = 0; k < 3000; ++k) check.add(static_cast<std::size_t>(k % 3), std::sin(k * k), 0.5);
    solution.consistency = check.judge();
  }
  report.solution = std::move(solution);
  return report;
}

TEST(TiltReport, GivesANullAndItsReasonWhereThereIsNoRoll) {
  const std::string json = tilt_json(fake_tilt(false));
  EXPECT_NE(json.find("\"roll_rad\": null"), std::string::npos);
  EXPECT_NE(json.find("roll_rad: null: the x axis stands upright"), std::string::npos);
  EXPECT_NE(json.find("\"mode\": \"still\""), std::string::npos);
  EXPECT_EQ(json.find("consistency"), std::string::npos);
}

TEST(TiltReport, SaysTheAnglesInDegreesWithTheirStandardDeviations) {
  EXPECT_EQ(tilt_conclusion(fake_tilt(false)),
            "Roll not determined, pitch 90.0 ± 0.6°, over one rest.");
  EXPECT_NE(tilt_text(fake_tilt(false)).find("No roll: the x axis stands upright."),
            std::string::npos);
}

TEST(TiltReport, ShowsOnThePageWhatWasToldLessAndEscapesNames) {
  const std::string page = tilt_html(fake_tilt(true));
  EXPECT_NE(page.find("reading told less"), std::string::npos);
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
  TiltReport report;
  report.inputs = {"motor.dat"};
  estimate::AxisTiltSolution axis;
  axis.samples = 1;
  axis.angle_rad = {0.1, 0.01};
  report.axis = axis;
  const std::string json = tilt_json(report);
  EXPECT_NE(json.find("\"mode\": \"angle\""), std::string::npos);
  EXPECT_NE(json.find("roll_rad, pitch_rad: null"), std::string::npos);
  EXPECT_EQ(tilt_conclusion(report), "The angle is 5.7 ± 0.6° at the end.");
}

}  // namespace
}  // namespace proofmass::report::tilt_report_test
