#include "proofmass/report/record_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/schema_test_support.hpp"

namespace proofmass::report::record_report_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RecordReport whole_recording() {
  RecordReport report;
  report.source = "sim:";
  report.settings = {{"rate", "200 Hz"}};
  report.summary.files = {"run.mcap"};
  report.summary.end = RecordEnd::duration;
  report.summary.samples = 12000;
  report.summary.duration_s = 60.0;
  report.summary.clock.start_realtime_ns = 1'795'350'605'250'000'000;
  report.summary.head = Recording{};
  report.summary.head->channels = {{"acc_x", *parse_unit("m/s^2"), {}}, {"c2", {}, {}}};
  return report;
}

RecordEvent gap_event() {
  return {EventKind::gap, Severity::bad, 12.4, 0.5, 100, "0.5 s without a sample"};
}

TEST(RecordReport, ReportsThatNothingIsMissing) {
  const RecordReport report = whole_recording();
  EXPECT_THAT(to_text(describe(report)),
              HasSubstr("12\u202f000 samples of 2 channels over 60 s from sim: to run.mcap"));
  EXPECT_THAT(to_text(describe(report)), HasSubstr("Nothing was lost, and there is no gap."));
  EXPECT_FALSE(describe(report).bad);
}

TEST(RecordReport, NamesGapsWithTheirTime) {
  RecordReport report = whole_recording();
  report.summary.gaps = {gap_event()};
  report.summary.gap_count = 1;
  report.summary.lost = 100;
  const std::string text = to_text(describe(report));
  EXPECT_THAT(text, HasSubstr("100 samples lost in 1 gap."));
  EXPECT_THAT(text, HasSubstr("12.40 s  0.5 s without a sample"));
  EXPECT_TRUE(describe(report).bad);
}

TEST(RecordReport, DoesNotReportACompleteRecordingIfTheDiskFailed) {
  RecordReport report = whole_recording();
  report.summary.end = RecordEnd::disk_failed;
  report.summary.lost = report.summary.not_written = 19'200;
  const std::string text = to_text(describe(report));
  EXPECT_THAT(text, Not(HasSubstr("Nothing was lost")));
  EXPECT_THAT(text, HasSubstr("19\u202f200 samples are in no file, since the disk failed."));
  EXPECT_THAT(text, Not(HasSubstr("lost in")));
  EXPECT_EQ(nlohmann::json::parse(to_json(describe(report)))["lost"], 19200);
}

TEST(RecordReport, CountsTheGapsThatAreNotListed) {
  RecordReport report = whole_recording();
  report.summary.gaps.assign(10, gap_event());
  report.summary.gap_count = 5000;
  EXPECT_THAT(to_text(describe(report)), HasSubstr("Gaps, the first 10 of 5\u202f000"));
}

TEST(RecordReport, DocumentHasWhatTheContractNames) {
  RecordReport report = whole_recording();
  report.summary.gaps = {gap_event()};
  report.summary.gap_count = 1;
  report.summary.lost = 100;
  const auto document = nlohmann::json::parse(to_json(describe(report)));
  EXPECT_EQ(document["samples"], 12000);
  EXPECT_EQ(document["lost"], 100);
  EXPECT_EQ(document["gaps"], 1);
  EXPECT_EQ(document["file"], "run.mcap");
  EXPECT_EQ(document["gap_list"][0]["start_s"], 12.4);
  EXPECT_EQ(document["end"], "duration");
  EXPECT_EQ(document["clock"]["start"], "2026-11-22T12:30:05.250Z");
}

TEST(RecordReport, EveryNullHasItsReason) {
  const auto document = nlohmann::json::parse(to_json(describe(whole_recording())));
  std::string warnings;
  for (const auto& warning : document["warnings"]) warnings += warning.get<std::string>() + "\n";
  EXPECT_TRUE(document["latency"].is_null());
  EXPECT_THAT(warnings, HasSubstr("latency: null"));
  EXPECT_THAT(warnings, HasSubstr("rate_error_ppm"));
  EXPECT_THAT(warnings, HasSubstr("(c2): unit: null"));
}

TEST(RecordReport, NamesWhyTheSourceWasLost) {
  RecordReport report = whole_recording();
  report.summary.end = RecordEnd::source_gone;
  report.summary.end_reason = "serial:/dev/ttyACM0: was unplugged";
  EXPECT_THAT(to_text(describe(report)), HasSubstr("/dev/ttyACM0: was unplugged"));
  EXPECT_THAT(to_json(describe(report)), HasSubstr("source_gone"));
}

TEST(RecordReport, HasClockAndLatencyIfKnown) {
  RecordReport report = whole_recording();
  EXPECT_THAT(to_text(describe(report)), Not(HasSubstr("Clock")));
  report.summary.clock.rate_error = Uncertain{12e-6, 1e-6};
  report.summary.clock.rate_hz = Uncertain{199.9976, 0.0002};
  report.summary.latency = Latency{6000, 0.0004, 0.0021, 0.01};
  const std::string text = to_text(describe(report));
  EXPECT_THAT(text, HasSubstr("199.99760 ± 0.00020 Hz"));
  EXPECT_THAT(text, HasSubstr("12.0 ± 1.0 ppm"));
  EXPECT_THAT(text, HasSubstr("Median                    0.40 ms"));
  EXPECT_THAT(text, HasSubstr("99 % of estimates within  2.1 ms"));
}

TEST(Schemas, Record) {
  RecordReport full = whole_recording();
  full.summary.gaps = full.summary.events = {gap_event()};
  full.summary.latency = Latency{6000, 0.0004, 0.0021, 0.01};
  const SourceList list{{{"sim:wheel", "the twin"}}, {{"iio:local:", "LIS3DH"}}, {}};
  expect_schema_of_kinds(
      "What was recorded, what is missing from it, and what happened; with --list, the sources "
      "that "
      "can be recorded from.",
      {{describe(full)}, {describe(list)}});
}

TEST(SourceList, ShowsWhatIsThereAndAllKinds) {
  const SourceList list{{{"sim:wheel?rate=200", "the twin"}}, {{"iio:local:", "LIS3DH"}}, {}};
  EXPECT_THAT(to_text(describe(list)), HasSubstr("iio:local:  LIS3DH"));
  EXPECT_THAT(to_text(describe(list)), HasSubstr("sim:wheel?rate=200\n      the twin"));
  EXPECT_EQ(nlohmann::json::parse(to_json(describe(list)))["found"][0]["uri"], "iio:local:");
}

}  // namespace
}  // namespace proofmass::report::record_report_test
