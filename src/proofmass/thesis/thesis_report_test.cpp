#include "proofmass/thesis/thesis_report.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "proofmass/report/schema_test_support.hpp"
#include "proofmass/thesis/thesis_fake.hpp"

namespace proofmass::thesis::thesis_report_test {
namespace {

using Json = nlohmann::ordered_json;
using report::to_html;
using report::to_json;
using report::to_text;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ThesisJson, HasEachNumberUnderItsKeyInSi) {
  const Json item = Json::parse(to_json(describe(fake_report())))["items"][1];
  EXPECT_EQ(item["id"], "figure 5.13");
  EXPECT_EQ(item["chapter"], "5");
  EXPECT_EQ(item["thesis"]["text"], "3.58 m.");
  EXPECT_DOUBLE_EQ(item["thesis"]["values"]["at_2_s"]["value"].get<double>(), 3.6);
  EXPECT_DOUBLE_EQ(item["ours"]["values"]["at_2_s"]["std"].get<double>(), 0.001);
  EXPECT_EQ(item["ours"]["values"]["at_2_s"]["unit"], "m");
}

TEST(ThesisJson, HasNoThesisValueIfNoneIsPrinted) {
  const Json item = Json::parse(to_json(describe(fake_report())))["items"][2];
  EXPECT_TRUE(item["thesis"]["values"].empty());
  EXPECT_EQ(item["ours"]["values"].size(), 1U);
}

TEST(ThesisJson, GivesTheReasonOfANullByItsKey) {
  const Json json = Json::parse(to_json(describe(fake_report())));
  EXPECT_TRUE(json["items"][1]["ours"]["values"]["lost"].is_null());
  EXPECT_EQ(json["warnings"].size(), 2U);
  EXPECT_EQ(json["warnings"][1],
            "items[1] (figure 5.13).ours.values.lost: null: Error <1>: the recording is too short");
}

TEST(ThesisJson, GivesAReasonForWhatIsNotFinite) {
  ThesisReport report = fake_report();
  report.programme.items[0].findings[0].ours = Uncertain{NAN, 0.0};
  const Json json = Json::parse(to_json(describe(report)));
  EXPECT_TRUE(json["items"][0]["ours"]["values"]["after_1_s"].is_null());
  EXPECT_TRUE(has(json["warnings"].dump(), "after_1_s"));
}

TEST(ThesisJson, SaysWhatWasSimulatedAndHow) {
  const Json json = Json::parse(to_json(describe(fake_report())));
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["runs"], 50);
  EXPECT_EQ(json["simulated"], (std::vector<std::string>{"static", "tumble"}));
  EXPECT_EQ(json["summary"]["agreeing"], 1);
}

TEST(ThesisHtml, LinksItsContentsToEachChapterAndItem) {
  const std::string html = to_html(describe(fake_report()));
  for (const char* id : {"chapter-2", "table-2.1", "chapter-5", "figure-5.13", "figure-5.19"}) {
    EXPECT_TRUE(has(html, "<a href=\"#" + std::string(id) + "\">")) << id;
    EXPECT_TRUE(has(html, " id=\"" + std::string(id) + "\">")) << id;
  }
}

TEST(ThesisHtml, HasAllThreeTextsAndTheNumbersBesideEachOther) {
  const std::string html = to_html(describe(fake_report()));
  EXPECT_TRUE(has(html, "It prints &lt;16&gt; cells."));
  EXPECT_TRUE(has(html, "They agree; the formula is ½ b t²."));
  EXPECT_TRUE(has(html, "<td>3600 mm</td><td>100.0\u00a0±\u00a01.0 mm</td><td>1/36</td>"));
  EXPECT_TRUE(has(html, "<li>Error &lt;1&gt;: the recording is too short</li>"));
}

TEST(ThesisHtml, GivesItsFiguresNoNumbersOfTheirOwn) {
  const std::string html = to_html(describe(fake_report()));
  EXPECT_TRUE(has(html, "<b>Error &amp; time</b>"));
  EXPECT_FALSE(has(html, "Figure 1. "));
}

TEST(ThesisHtml, HasNoIdTwice) {
  const std::string html = to_html(describe(fake_report()));
  std::vector<std::string> ids;
  for (std::size_t at = html.find(" id=\""); at != std::string::npos;
       at = html.find(" id=\"", at + 1))
    ids.push_back(html.substr(at + 5, html.find('"', at + 5) - at - 5));
  std::ranges::sort(ids);
  EXPECT_EQ(std::ranges::adjacent_find(ids), ids.end());
}

TEST(ThesisText, HasALineOrTwoForEachItem) {
  const std::string text = to_text(describe(fake_report()));
  EXPECT_TRUE(has(
      text,
      "\nChapter 2. Robot Localization\n  Table 2.1. Position error (1 of 1 agree)\n"
      "      Error <1>: 15 mm in the thesis, 15 mm ours. They agree; the formula is ½ b t².\n"));
  EXPECT_TRUE(
      has(text, "  Figure 5.19. Angle\n      Error <1>: 2.00 ± 0.10 mm. Ours has a band.\n"));
  EXPECT_TRUE(has(text, "seed 7, 50 runs at each speed: static, tumble."));
}

TEST(ThesisText, CountsWhatAgrees) {
  EXPECT_TRUE(
      to_text(describe(fake_report()))
          .starts_with("3 tables, figures and sections of the thesis, recomputed. They "
                       "print 3 numbers: 1 agree with ours, 1 do not, 1 cannot be recomputed. "));
}

TEST(ThesisSchema, IsTheGeneratedOne) {
  ThesisReport report = fake_report();
  report.programme.items[2].findings[0].si_unit = "s";  // its numbers have units of their own
  report::expect_schema(
      "Every table and figure of the thesis beside ours. Numbers are in the unit "
      "beside them, SI; \"1\" is a number without unit.",
      {describe(report)});
}

}  // namespace
}  // namespace proofmass::thesis::thesis_report_test
