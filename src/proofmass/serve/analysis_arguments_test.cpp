#include "proofmass/serve/analysis_arguments.hpp"

#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve::analysis_arguments_test {
namespace {

using nlohmann::json;

class AnalysisArgumentsTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"a.csv", "-o.csv", "it's.csv", "s.toml"})
      std::ofstream(home_.path() + "/" + name) << "1\n";
  }
  [[nodiscard]] Result<AnalysisArguments> asked(const std::string& text) const {
    const json verbs = json::parse(R"({"verbs": [
      {"name": "noise", "many_files": true, "page": true, "series": true, "sensor_file": true, "options": [
        {"name": "rate"}, {"name": "channel", "many": true}, {"name": "sensor", "file": true},
        {"name": "exclude-events", "switch": true}]},
      {"name": "sensor diff", "many_files": true, "options": []},
      {"name": "wheel", "options": []}]})");
    return analysis_arguments(verbs, json::parse(text), Folder::open(home_.path()).value());
  }
  [[nodiscard]] std::string refusal_of(const std::string& text) const {
    const auto found = asked(text);
    return found ? "" : found.error().message;
  }

  TemporaryFolder home_ = TemporaryFolder::make(testing::TempDir()).value();
};

TEST_F(AnalysisArgumentsTest, GluesValuesToTheirFlags) {
  const auto found = asked(R"({"verb": "noise", "files": ["a.csv", "-o.csv"], "sensor_file": true,
    "options": {"rate": 100.5, "channel": ["x", "--json"], "exclude-events": true, "sensor": "s.toml"}})");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->arguments, (std::vector<std::string>{"noise", "a.csv", "./-o.csv", "--channel=x",
                                                        "--channel=--json", "--exclude-events",
                                                        "--rate=100.5", "--sensor=s.toml"}));
  EXPECT_TRUE(found->writes_page);
  EXPECT_TRUE(found->writes_series);
  EXPECT_TRUE(found->writes_sensor_file);
}

TEST_F(AnalysisArgumentsTest, AnActionIsAWordOfItsOwn) {
  const auto found = asked(R"({"verb": "sensor diff", "files": ["s.toml", "s.toml"]})");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->arguments, (std::vector<std::string>{"sensor", "diff", "s.toml", "s.toml"}));
  EXPECT_FALSE(found->writes_page);
}

TEST_F(AnalysisArgumentsTest, RefusesWhatIsNotInTheTable) {
  EXPECT_EQ(refusal_of(R"({"verb": "record", "files": ["a.csv"]})"), "no such analysis");
  EXPECT_EQ(refusal_of(R"({"verb": "noise", "files": ["a.csv"], "options": {"json": "/etc/x"}})"),
            "noise has no option json");
  EXPECT_NE(refusal_of(R"({"verb": "wheel", "files": ["a.csv", "a.csv"]})"), "");
  for (const char* text :
       {R"({})", R"([])", R"({"verb": 1})", R"({"verb": "noise"})",
        R"({"verb": "noise", "files": []})", R"({"verb": "noise", "files": [1]})",
        R"({"verb": "noise", "files": ["a.csv"], "options": []})"})
    EXPECT_NE(refusal_of(text), "") << text;
}

TEST_F(AnalysisArgumentsTest, RefusesFilesOutsideTheFolder) {
  const std::string outside = "the file lies outside the folder that is served";
  EXPECT_EQ(refusal_of(R"({"verb": "noise", "files": ["../a.csv"]})"), outside);
  EXPECT_EQ(refusal_of(R"({"verb": "noise", "files": ["/etc/passwd"]})"), outside);
  EXPECT_EQ(
      refusal_of(R"({"verb": "noise", "files": ["a.csv"], "options": {"sensor": "/etc/passwd"}})"),
      "--sensor: " + outside);
}

TEST_F(AnalysisArgumentsTest, RefusesValuesOfTheWrongKind) {
  for (const char* options : {R"({"rate": [1, 2]})", R"({"rate": null})", R"({"rate": {"a": 1}})",
                              R"({"rate": "1\n2"})", R"({"exclude-events": "yes"})"})
    EXPECT_NE(refusal_of(R"({"verb": "noise", "files": ["a.csv"], "options": )" +
                         std::string(options) + "}"),
              "")
        << options;
}

TEST(ShellCommand, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_command({"noise", "a b.csv", "--unit=g", "it's.csv"}),
            "proofmass noise 'a b.csv' --unit=g 'it'\\''s.csv'");
}

}  // namespace
}  // namespace proofmass::serve::analysis_arguments_test
