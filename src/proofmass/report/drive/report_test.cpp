#include "proofmass/report/drive/report.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/schema_test_support.hpp"

namespace proofmass::report::drive_report_test {
namespace {

using testing::HasSubstr;

// A quarter circle of 100 m to the left, with figures that are made up.
DriveReport quarter_circle() {
  DriveReport report;
  report.inputs = {"right.csv", "left.csv", "fixes.csv"};
  report.notes = {{Severity::warning, "fixes.csv: its stamps fit the wheels only times 0.1"}};
  estimate::DriveSolution& solution = report.solution;
  solution.distance_m = Uncertain{100.0, 0.1};
  solution.heading_change_rad = Uncertain{1.5707963, 0.01};
  solution.heading_start_rad = Uncertain{0.3, 0.02};
  solution.end_m = {Uncertain{63.66, 0.5}, Uncertain{63.66, 0.6}};
  solution.closure_m = Uncertain{90.03, 0.5};
  solution.reference_point = "middle between the wheels";
  solution.origin_deg = {48.0, 11.0};
  solution.has_fixes = true;
  solution.track_m = Uncertain{1.5, 0.01};
  solution.wheelbase_m = Uncertain{2.6, 0.05};
  for (const char* name : {"right.csv", "left.csv"}) {
    estimate::DriveWheelFit& wheel = solution.wheels.emplace_back();
    wheel.name = name;
    wheel.side = std::string(name) == "left.csv" ? estimate::VehicleSide::left
                                                 : estimate::VehicleSide::right;
    wheel.turns = Uncertain{53.1, 0.01};
    wheel.circumference_m = Uncertain{1.885, 0.002};
    wheel.has_yaw = true;
    wheel.clock_offset_s = Uncertain{0.0, 0.0};
  }
  solution.fixes = estimate::DriveFixesFit{.name = "fixes.csv",
                                           .fixes = 100,
                                           .used = 98,
                                           .time_scale = 0.1,
                                           .noise_m = 0.2,
                                           .wander_m = 1.0,
                                           .wander_s = 30.0,
                                           .path_m = 112.0,
                                           .clock_offset_s = Uncertain{1.5, 0.02}};
  solution.not_observable = {"heading: made up"};
  estimate::DriveSeries& series = solution.series;
  constexpr double radius_m = 63.6619772;
  for (int k = 0; k <= 100; ++k) {
    const double turned = 0.015707963 * k;
    series.time_s.push_back(0.1 * k);
    series.x_m.push_back(radius_m * std::sin(turned));
    series.y_m.push_back(radius_m * (1.0 - std::cos(turned)));
    series.heading_rad.push_back(turned);
    series.distance_m.push_back(k);
    series.speed_mps.push_back(10.0);
    series.rate_radps.push_back(0.157);
    series.x_std_m.push_back(0.005 * k);
    series.y_std_m.push_back(0.006 * k);
    series.xy_cov_m2.push_back(0.0);
    series.heading_std_rad.push_back(0.0001 * k);
    series.speed_std_mps.push_back(0.02);
  }
  return report;
}

DriveReport nothing_known() {
  DriveReport report;
  report.inputs = {"right.csv"};
  report.solution.reference_point = "contact point";
  report.solution.wheels.push_back({});
  report.solution.wheels.front().name = "right.csv";
  report.solution.frame_clock_offset_s = Uncertain{0.1, 0.01};
  report.solution.not_observable = {"distance: no circumference", "heading: one side"};
  return report;
}

TEST(DriveReport, SaysDistanceHeadingAndClosureInASentence) {
  const DriveReport report = quarter_circle();
  EXPECT_THAT(to_text(describe(report)),
              HasSubstr("The vehicle travelled 100.00 ± 0.10 m and turned by 90.0"));
}

TEST(DriveReport, GivesTheReasonOfEveryNull) {
  const DriveReport report = nothing_known();
  const std::string json = to_json(describe(report));
  EXPECT_THAT(json, HasSubstr("\"distance_m\": null"));
  EXPECT_THAT(json, HasSubstr("no circumference"));
  EXPECT_THAT(json, HasSubstr("one side"));
}

TEST(DriveReport, DrawsAMetreAlikeAlongBothAxes) {
  const DriveReport report = quarter_circle();
  const Figure figure = path_figure(report.solution);
  const double across = (*figure.x.max - *figure.x.min) / 808.0;
  const double along = (*figure.y.max - *figure.y.min) / figure.height;
  EXPECT_NEAR(across, along, 1e-12 + 1e-9 * across);
}

TEST(DriveReport, GeoJsonHasThePathInLongitudeAndLatitude) {
  const DriveReport report = quarter_circle();
  const auto json = nlohmann::json::parse(drive_geojson(report));
  EXPECT_EQ(json["type"], "FeatureCollection");
  const auto& line = json["features"][0]["geometry"]["coordinates"];
  ASSERT_EQ(line.size(), 101u);
  EXPECT_DOUBLE_EQ(line[0][0], 11.0);
  // One arc minute of latitude is a nautical mile, 1852 m, within 0.6 % at 48 degrees.
  EXPECT_NEAR((line[100][1].get<double>() - 48.0) * 60.0 * 1852.0, 63.66, 0.6);
}

TEST(Schemas, Drive) {
  expect_schema("Path of a vehicle from sensors on its wheels.",
                {describe(quarter_circle()), describe(nothing_known())});
}

}  // namespace
}  // namespace proofmass::report::drive_report_test
