#include "proofmass/core/number_words.hpp"

#include <gtest/gtest.h>

namespace proofmass::number_words_test {
namespace {

TEST(Fixed, HasATrueMinusSignButNoneBeforeZero) {
  EXPECT_EQ(fixed(-1.25, 1), "−1.2");
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(1234.0, -2), "1200");
}

TEST(Significant, TurnsToPowersOfTenWherePlainDigitsWouldNotBeRead) {
  EXPECT_EQ(significant(120.0051, 4), "120.0");
  EXPECT_EQ(significant(0.0021, 2), "0.0021");
  EXPECT_EQ(significant(3.0e34, 3), "3.00e+34");
  EXPECT_EQ(significant(-2.5e-7, 2), "−2.5e-07");
  EXPECT_EQ(significant(0.0, 3), "0");
}

TEST(Compact, LeavesNoZerosBehind) {
  EXPECT_EQ(compact(60.0, 7), "60");
  EXPECT_EQ(compact(120.00482, 7), "120.0048");
  EXPECT_EQ(compact(-0.5, 3), "−0.5");
}

}  // namespace
}  // namespace proofmass::number_words_test
