#include "proofmass/io/positions/direction_label.hpp"

#include <gtest/gtest.h>

namespace proofmass::io::direction_label_test {
namespace {

using Direction = std::array<double, 3>;

TEST(DirectionOfLabel, ReadsTheUsualNamesOfTheSixPositions) {
  for (const char* label : {"x_p", "X_P", "xp", "+x", "x+", "+X", "x up", "x_up", "X-up", "up x",
                            "xpos", "x positive", "plus_x", "x axis up", "+1g x", "x_p 2", "x=+1"})
    EXPECT_EQ(direction_of_label(label), (Direction{1, 0, 0})) << label;
  for (const char* label : {"y_a", "ya", "-y", "y-", "\u2212y", "y down", "Y_DOWN", "y_neg", "yneg",
                            "negy", "y_n", "y minus", "y = -1 g", "y_-1", "axis y: down"})
    EXPECT_EQ(direction_of_label(label), (Direction{0, -1, 0})) << label;
  EXPECT_EQ(direction_of_label("z_a"), (Direction{0, 0, -1}));
  EXPECT_EQ(direction_of_label("z_p"), (Direction{0, 0, 1}));
}

TEST(DirectionOfLabel, SaysNothingWhereTheNameSaysNothing) {
  for (const char* label :
       {"", "x", "x_rot", "y_rot", "walking", "up", "-", "x y", "x+y-", "ax", "a_x", "x_up_down",
        "x-1", "pose 3", "x1", "xylophone up", "+-x", "\xff"})
    EXPECT_EQ(direction_of_label(label), std::nullopt) << label;
}

}  // namespace
}  // namespace proofmass::io::direction_label_test
