#include "proofmass/report/inspect_report.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace proofmass::report::inspect_report_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// Two samples of one channel, without values or times.
struct Empty {
  Recording recording;
  signal::RecordingAudit audit;

  Empty() {
    recording.channels = {{"a", {}, {std::nan(""), std::nan("")}}};
    audit.format = "CSV";
    audit.samples = 2;
    audit.channels.resize(1);
    audit.channels[0].name = "a";
    audit.channels[0].nonfinite = 2;
    audit.notes = {{Severity::info, "separator ','"}, {Severity::bad, "a: no value"}};
  }

  [[nodiscard]] InspectedFile as(const std::string& name) const { return {name, recording, audit}; }
};

TEST(InspectReport, HasNullAndAReasonForAChannelWithoutAValue) {
  const Empty empty;
  const json document = json::parse(to_json(describe({empty.as("f.csv")})));
  EXPECT_TRUE(document["channels"][0]["mean"].is_null());
  EXPECT_TRUE(document["rate_hz"].is_null());
  EXPECT_TRUE(document["timing"]["lost"].is_null());
  EXPECT_EQ(document["channels"][0]["nonfinite"], 2);
  const std::string warnings = document["warnings"].dump();
  EXPECT_THAT(warnings,
              HasSubstr("channels[0] (a): mean, std, min, max: null: no plausible value"));
  EXPECT_THAT(warnings, HasSubstr("duration_s, rate_hz: null: no time column"));
  EXPECT_THAT(warnings, HasSubstr("timing.lost: null: no packet counter"));
}

TEST(InspectReport, PrintsEveryNoteWithItsSeverity) {
  const Empty empty;
  const std::string text = to_text(describe({empty.as("f.csv")}));
  EXPECT_THAT(text, HasSubstr("1 channel: 1 fault in the data."));
  EXPECT_THAT(text, HasSubstr("note: separator ','"));
  EXPECT_THAT(text, HasSubstr("bad data: a: no value"));
}

TEST(InspectReport, HasEachOfSeveralFilesAndTheFirstAtTheTop) {
  Empty one, other;
  other.audit.samples = 3;
  const Document both = describe({one.as("d/f.csv"), other.as("g.csv")});
  const json document = json::parse(to_json(both));
  EXPECT_EQ(document["samples"], 2);
  EXPECT_EQ(document["files"][1]["samples"], 3);
  EXPECT_EQ(document["files"][0]["file"], "d/f.csv");
  EXPECT_EQ(document["warnings"][0], "f.csv: a: no value");
  EXPECT_THAT(to_text(both), HasSubstr("\ng.csv: 3 samples at an unknown rate"));
  EXPECT_FALSE(json::parse(to_json(describe({one.as("f.csv")}))).contains("files"));
}

TEST(InspectReport, ListsAllGaps) {
  Empty file;
  for (int k = 0; k < 5; ++k) file.audit.timing.gaps.push_back({1.0 * k, 0.5});
  const Document report = describe({file.as("f.csv")});
  const json gaps = json::parse(to_json(report))["timing"]["gaps"];
  ASSERT_EQ(gaps.size(), 5U);
  EXPECT_EQ(gaps[4], (json{{"start_s", 4.0}, {"duration_s", 0.5}}));
}

TEST(InspectReport, CountsLabelsInTheOrderOfTheirFirstAppearance) {
  Empty file;
  file.recording.label_channel = "part";
  file.recording.labels = {{"up", 0, 2}, {"down", 3, 3}, {"up", 4, 9}};
  const Document report = describe({file.as("f.csv")});
  const json labels = json::parse(to_json(report))["labels"];
  EXPECT_EQ(labels[0], (json{{"channel", "part"}, {"name", "up"}, {"runs", 2}, {"samples", 9}}));
  EXPECT_EQ(labels[1]["name"], "down");
  EXPECT_THAT(to_text(report), HasSubstr("Labels in column part:\n"));
}

TEST(InspectReport, DrawsThreeChannelsOfOneUnitTogether) {
  const Unit unit = *parse_unit("m/s^2");
  Recording recording;
  recording.time.rate_hz = 10.0;
  for (const char* name : {"x", "y", "z", "w"})
    recording.channels.push_back({name, unit, {1.0, 2.0}});
  const signal::RecordingAudit audit;
  const std::string page = to_html(describe({{"f.csv", recording, audit}}));
  EXPECT_THAT(page, HasSubstr("Figure 1. x, y, z"));
  EXPECT_THAT(page, HasSubstr("Figure 2. w"));
  EXPECT_THAT(page, Not(HasSubstr("Figure 3.")));
}

TEST(InspectReport, DrawsTheStepsBetweenTimeStampsOnlyIfTheyDiffer) {
  Recording recording;
  const signal::RecordingAudit audit;
  const InspectedFile file{"f.csv", recording, audit};
  recording.time.stamps_s = {0.0, 1.0, 2.0, 3.0};
  EXPECT_TRUE(inspect_plots(file).empty());
  recording.time.stamps_s = {0.0, 1.0, 3.0, 4.0};
  ASSERT_EQ(inspect_plots(file).size(), 1U);
  const Figure figure = inspect_plots(file)[0].draw();
  EXPECT_EQ(figure.bands[0].upper.front(), 2.0);  // two steps of 1 s
  EXPECT_EQ(figure.bands[0].upper.back(), 1.0);   // one of 2 s
}

}  // namespace
}  // namespace proofmass::report::inspect_report_test
