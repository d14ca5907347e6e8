#include "proofmass/report/recover_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace proofmass::report::recover_report_test {
namespace {

using ::testing::HasSubstr;

RecoverReport cut_recording() {
  RecoverReport report{"run.mcap.part", {}};
  report.recovery.file = "run.mcap";
  report.recovery.samples = 59500;
  report.recovery.last_s = 59.499;
  report.recovery.missing_rows = 120;
  report.recovery.notes = {{Severity::warning, "the end is missing: 812 bytes of a chunk"}};
  return report;
}

TEST(RecoverReport, SaysWhatWasSavedAndWhatIsMissing) {
  const Document document = describe(cut_recording());
  const std::string text = to_text(document);
  EXPECT_THAT(text, HasSubstr("59\u202f500 samples, from 0.00 s to 59.50 s, saved in run.mcap."));
  EXPECT_THAT(text, HasSubstr("Samples missing         120\n"));
  EXPECT_THAT(text, HasSubstr("warning: the end is missing"));
  const auto json = nlohmann::json::parse(to_json(document));
  EXPECT_EQ(json["samples"], 59500);
  EXPECT_EQ(json["warnings"][0], "the end is missing: 812 bytes of a chunk");
  EXPECT_TRUE(document.bad);
}

TEST(RecoverReport, CountsMessagesInFilesOfOtherProgramsAndIsNotBadIfWhole) {
  RecoverReport report{"other.mcap", {}};
  report.recovery.file = "other.recovered.mcap";
  report.recovery.messages = 12;
  report.recovery.was_whole = true;
  const Document document = describe(report);
  EXPECT_THAT(to_text(document), HasSubstr("12 messages saved in other.recovered.mcap. The file "
                                           "was whole: nothing was missing."));
  EXPECT_FALSE(document.bad);
}

}  // namespace
}  // namespace proofmass::report::recover_report_test
