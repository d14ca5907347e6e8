#include <gtest/gtest.h>

#include "proofmass/fleet/fleet_report.hpp"
#include "proofmass/fleet/summary.hpp"
#include "proofmass/report/schema_test_support.hpp"

namespace proofmass::fleet::documents_test {
namespace {

FleetReport fake_run() {
  FleetReport report;
  report.manifest = "night.csv";
  report.analysis = "noise";
  report.folder = "results";
  report.jobs = 10;
  report.done = 7;
  report.skipped = 1;
  report.failed = {{"a.csv", "no row of numbers"}, {"b.csv", "took longer than 5 s (--timeout)"}};
  report.shard = {1, 4};
  report.processes = 2;
  report.elapsed_s = 90.0;
  report.busy_s = 150.0;
  return report;
}

FigureSummary fake_figure() {
  FigureSummary figure;
  figure.name = "white";
  figure.channel = "acc_x";
  figure.unit = "m/s^2/sqrt(Hz)";
  for (std::size_t k = 0; k < 4; ++k)
    figure.values.push_back({.sensor = k % 2,
                             .value = 1.0 + static_cast<double>(k),
                             .std = 0.1,
                             .day = 20000.0 + static_cast<double>(k),
                             .temperature_c = 20.0,
                             .file = "a.csv",
                             .page = "documents/a.csv.json"});
  figure.is_tested = true;
  figure.outliers = {{.sensor = 1, .mean = 3.0, .z = 8.0, .p = 1e-6, .adjusted_p = 1e-4}};
  figure.type.emplace();
  figure.type->sensors = 3;
  figure.type->mean = {1.0, 0.1};
  figure.type->within_std = 0.2;
  figure.per_day = Trend{.slope = {1e-3, 1e-4}, .slope_95 = {8e-4, 1.2e-3}, .p = 1e-9};
  figure.per_kelvin = Trend{.slope = {1e-3, 1e-2}, .slope_95 = {-2e-2, 2e-2}, .p = 0.9};
  figure.per_day_adjusted_p = 1e-8;
  figure.yields = {{parse_limit("white<2").value(), 1, 2, {0.1, 0.9}, {1}}};
  return figure;
}

Summary fake_summary() {
  Summary summary;
  summary.folder = "results";
  summary.sensors = {"S00", "S01"};
  summary.recordings = 4;
  summary.failures = 1;
  summary.family_tests = 2;
  summary.trend_tests = 2;
  summary.figures = {fake_figure(), fake_figure(), fake_figure()};
  summary.figures[1].type->within_std.reset();
  FigureSummary& bare = summary.figures[2];
  bare.type.reset();
  bare.per_day.reset();
  bare.per_kelvin.reset();
  return summary;
}

TEST(FleetSchema, OfARunIsTheGeneratedOne) {
  report::expect_schema("A verb for every recording of a manifest or folder.",
                        {describe(fake_run())});
}

TEST(FleetSchema, OfASummaryIsTheGeneratedOne) {
  const Summary summary = fake_summary();
  report::expect_schema("What the results of a fleet show together. SI.", {describe(summary, "")},
                        "fleet_summary");
}

TEST(FleetText, ListsWhatFailedWithItsReasonAndWhereTheResultsAre) {
  const std::string text = to_text(describe(fake_run()));
  EXPECT_TRUE(text.starts_with(
      "10 recordings of night.csv: 7 done, 1 skipped, 2 failed, in 90 s with 2 processes. Shard 1 "
      "of 4, counted from 0.\n"))
      << text;
  EXPECT_NE(text.find("b.csv      took longer than 5 s (--timeout)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("results/results.parquet"), std::string::npos);
}

TEST(FleetText, OfASummaryHasTheOutliersTheTypeAndTheTrendsThatAreSignificant) {
  const Summary summary = fake_summary();
  const std::string text = to_text(describe(summary, ""));
  EXPECT_TRUE(text.starts_with("4 recordings of 2 sensors; 1 failed. Out of family: S01.\n"));
  EXPECT_NE(text.find("per day"), std::string::npos);
  EXPECT_EQ(text.find("per K"), std::string::npos);
  EXPECT_NE(text.find("1 of 2"), std::string::npos);
  EXPECT_EQ(text.find("documents/a.csv.json"), std::string::npos);  // a link of the page alone
}

}  // namespace
}  // namespace proofmass::fleet::documents_test
