#include "proofmass/signal/recording_sequence.hpp"

#include <gtest/gtest.h>

namespace proofmass::signal::recording_sequence_test {
namespace {

TEST(RecordingSequence, CountsWhatIsMissingBetweenRecordings) {
  RecordingSequence sequence(10.0);
  EXPECT_EQ(sequence.append(100.0, 50).value(), 0U);   // 100 s … 105 s
  EXPECT_EQ(sequence.append(105.0, 50).value(), 0U);   // directly after
  EXPECT_EQ(sequence.append(112.0, 30).value(), 20U);  // 2 s later
  EXPECT_EQ(sequence.samples(), 150U);
}

// 1/3 s at 10 Hz is 3.33 samples: each start is rounded by itself.
TEST(RecordingSequence, DoesNotAccumulateRounding) {
  RecordingSequence sequence(10.0);
  for (int k = 0; k < 300; ++k) {
    const double start_s = k * (1.0 + 1.0 / 3.0);
    ASSERT_TRUE(sequence.append(start_s, 10));
  }
  EXPECT_NEAR(static_cast<double>(sequence.samples()), 299 * 13.333333 + 10.0, 1.0);
}

TEST(RecordingSequence, TakesAnOverlapOfASecondAsNone) {
  RecordingSequence sequence(10.0);
  ASSERT_TRUE(sequence.append(0.0, 100));
  EXPECT_EQ(sequence.append(9.2, 100).value(), 0U);
  EXPECT_EQ(sequence.samples(), 200U);
}

TEST(RecordingSequence, ShortensGapsToTheLongestThatIsAllowed) {
  RecordingSequence sequence(10.0, 500);
  ASSERT_TRUE(sequence.append(0.0, 100));
  EXPECT_EQ(sequence.append(604800.0, 100).value(), 500U);
  EXPECT_EQ(sequence.append(604815.0, 100).value(), 50U);  // as long as it is
  EXPECT_EQ(sequence.samples(), 850U);
}

TEST(RecordingSequence, RefusesALongerOne) {
  RecordingSequence sequence(10.0);
  ASSERT_TRUE(sequence.append(0.0, 100));
  const auto overlapping = sequence.append(5.0, 100);
  ASSERT_FALSE(overlapping);
  EXPECT_EQ(overlapping.error().message, "starts 5 s before the end of the recording before it");
}

}  // namespace
}  // namespace proofmass::signal::recording_sequence_test
