#include "proofmass/thesis/programme.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace proofmass::thesis::programme_test {
namespace {

// Shortened: two hours at rest would dominate the run time.
const Programme& simulated() {
  static const Programme programme =
      run_programme({}, {.seeds = 2, .static_duration_s = 600.0}).value();
  return programme;
}

TEST(Programme, HasEveryTableAndFigureOnceInTheOrderOfTheThesis) {
  const std::vector<std::string> order{
      "table 2.1",   "figure 4.3",  "figure 4.5",  "table 4.1",   "figure 4.6",  "figure 5.2",
      "figure 5.3",  "figure 5.4",  "figure 5.5",  "figure 5.6",  "table 5.1",   "figure 5.7",
      "figure 5.8",  "figure 5.9",  "figure 5.10", "figure 5.12", "figure 5.13", "figure 5.14",
      "figure 5.15", "figure 5.16", "figure 5.17", "figure 5.18", "figure 5.19", "section 6.1",
      "section 6.2", "table A.1",   "section A.2"};
  std::vector<std::string> found;
  for (const Item& item : simulated().items) found.push_back(item.id);
  EXPECT_EQ(found, order);
}

void expect_texts(const Item& item) {
  EXPECT_FALSE(item.title.empty()) << item.id;
  EXPECT_FALSE(item.thesis.empty()) << item.id;
  EXPECT_FALSE(item.ours.empty()) << item.id;
  EXPECT_FALSE(item.note.empty()) << item.id;
}

void expect_number_or_reason(const Finding& finding, const std::string& which) {
  EXPECT_FALSE(finding.label.empty()) << which;
  EXPECT_NE(finding.ours.has_value(), !finding.reason.empty()) << which;
  EXPECT_TRUE(!finding.thesis || std::isfinite(*finding.thesis)) << which;
  EXPECT_GT(finding.shown.to_si, 0.0) << which;
  const bool same = finding.si_unit == finding.shown.symbol;
  EXPECT_TRUE(!same || finding.shown.to_si == 1.0) << which;
  if (!finding.ours) return;
  EXPECT_TRUE(std::isfinite(finding.ours->value)) << which;
  EXPECT_TRUE(finding.ours->std >= 0.0 && std::isfinite(finding.ours->std)) << which;
}

// A single test, since each runs in its own process and the programme takes a while.
TEST(Programme, GivesAllTextsAndEachNumberOnceOrAReason) {
  for (const Item& item : simulated().items) {
    expect_texts(item);
    std::set<std::string> keys;
    for (const Finding& finding : item.findings) {
      EXPECT_TRUE(keys.insert(finding.key).second) << item.id << ' ' << finding.key;
      expect_number_or_reason(finding, item.id + ' ' + finding.key);
    }
  }
  EXPECT_EQ(simulated().simulated, (std::vector<std::string>{"static", "tumble", "wheel"}));
}

}  // namespace
}  // namespace proofmass::thesis::programme_test
