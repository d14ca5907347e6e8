#include "proofmass/thesis/comparison.hpp"

#include <gtest/gtest.h>

#include "proofmass/thesis/chapters.hpp"
#include "proofmass/thesis/thesis_fake.hpp"

namespace proofmass::thesis::comparison_test {
namespace {

std::string against(double thesis, double ours) {
  return against_words(fake_finding("k", thesis, Uncertain{ours, 0.0}));
}

TEST(Comparison, AgreesWithinATenthOfWhatIsPrinted) {
  EXPECT_TRUE(agrees(fake_finding("k", 10.0, Uncertain{11.0, 0.0})));
  EXPECT_TRUE(agrees(fake_finding("k", -10.0, Uncertain{-9.0, 0.0})));
  EXPECT_FALSE(agrees(fake_finding("k", 10.0, Uncertain{11.01, 0.0})));
  EXPECT_FALSE(agrees(fake_finding("k", 10.0, Uncertain{-10.0, 0.0})));
}

TEST(Comparison, AgreesWithinTwoStandardDeviations) {
  EXPECT_TRUE(agrees(fake_finding("k", 0.0, Uncertain{0.19, 0.1})));
  EXPECT_FALSE(agrees(fake_finding("k", 0.0, Uncertain{0.21, 0.1})));
  EXPECT_FALSE(agrees(fake_finding("k", 0.0, Uncertain{1e-12, 0.0})));
  EXPECT_TRUE(agrees(fake_finding("k", 2.0, Uncertain{3.0, 0.5})));
}

TEST(Comparison, CountsUndeterminedFiguresAsPrintedOnly) {
  const Agreement all = agreement(fake_report().programme.items);
  EXPECT_EQ(all.printed, 3U);
  EXPECT_EQ(all.compared, 2U);
  EXPECT_EQ(all.agreeing, 1U);
}

TEST(Comparison, ShowsNumbersInTheUnitOfPeople) {
  const Finding finding = fake_finding("k", 0.015, Uncertain{0.0149, 0.0002});
  EXPECT_EQ(thesis_words(finding), "15 mm");
  EXPECT_EQ(ours_words(finding), "14.90 ± 0.20 mm");
  EXPECT_EQ(ours_words(fake_finding("k", {}, Uncertain{16.0, 0.0})), "16000 mm");
  EXPECT_EQ(thesis_words(fake_finding("k", {}, {})), "");
}

TEST(Comparison, SaysHowFarOursIsInWordsThatSuitTheSize) {
  EXPECT_EQ(against(2.0, 2.0), "the same");
  EXPECT_EQ(against(2.0, 2.0005), "the same");
  EXPECT_EQ(against(2.0, 2.1), "+5.0 %");
  EXPECT_EQ(against(2.0, 1.5), "−25 %");
  EXPECT_EQ(against(2.0, 72.0), "× 36");
  EXPECT_EQ(against(72.0, 2.0), "1/36");
  EXPECT_EQ(against(1e-3, 7.2), "× 7200");
  EXPECT_EQ(against(2.0, -2.0), "other sign");
  EXPECT_EQ(against(0.0, 0.002), "+2.0 mm");
  EXPECT_EQ(against_words(fake_finding("k", 1.0, {})), "");
  EXPECT_EQ(against_words(fake_finding("k", 2.0, Uncertain{3.0, 0.8})), "+50 %, 1 std");
  EXPECT_EQ(against_words(fake_finding("k", 2.0, Uncertain{2.1, 0.8})), "+5.0 %");
}

TEST(Chapters, GroupTheItemsByTheirNumber) {
  const std::vector<Item> items = fake_report().programme.items;
  const std::vector<Chapter> found = chapters(items);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].title, "Chapter 2. Robot Localization");
  EXPECT_EQ(found[1].key, "5");
  EXPECT_EQ(found[1].items.size(), 2U);
  EXPECT_EQ(chapter_key({.id = "section A.2", .title = {}, .thesis = {}, .ours = {}, .note = {}}),
            "A");
}

}  // namespace
}  // namespace proofmass::thesis::comparison_test
