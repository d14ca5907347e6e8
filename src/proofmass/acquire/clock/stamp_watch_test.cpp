#include "proofmass/acquire/clock/stamp_watch.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace proofmass::acquire::stamp_watch_test {
namespace {

TEST(StampWatch, KnowsAClockThatIsDead) {
  EXPECT_TRUE(is_dead({}));
  EXPECT_TRUE(is_dead({0}));
  EXPECT_TRUE(is_dead({0, 0, 0}));
  EXPECT_TRUE(is_dead({17, 17, 17}));
  EXPECT_FALSE(is_dead({17}));
  EXPECT_FALSE(is_dead({0, 10, 20}));
}

TEST(StampWatch, IsSilentWhileTheClockRuns) {
  StampWatch watch;
  std::vector<Note> notes;
  watch.look({1, 2, 3}, notes);
  watch.look({}, notes);
  watch.look({4}, notes);
  EXPECT_TRUE(notes.empty());
}

TEST(StampWatch, TellsRepeatedAndBackwardStampsAcrossBuffers) {
  StampWatch watch;
  std::vector<Note> notes;
  watch.look({1'000'000'000, 2'000'000'000}, notes);
  watch.look({2'000'000'000, 500'000'000}, notes);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0].text, "the device stamped 1 rows with the time of the row before");
  EXPECT_EQ(notes[1].text, "the device's stamps stepped back 1 times, by 1.5 s here");
}

TEST(StampWatch, DoesNotFloodTheRecording) {
  StampWatch watch;
  std::vector<Note> notes;
  for (int k = 0; k < 1000; ++k) watch.look({7, 8, 7}, notes);
  EXPECT_LE(notes.size(), 10U);
  EXPECT_GE(notes.size(), 6U);
}

TEST(StampWatch, SurvivesStampsAtTheEdgesOfWhatAnIntegerHolds) {
  StampWatch watch;
  std::vector<Note> notes;
  watch.look({std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()},
             notes);
  EXPECT_EQ(notes.size(), 1U);
}

}  // namespace
}  // namespace proofmass::acquire::stamp_watch_test
