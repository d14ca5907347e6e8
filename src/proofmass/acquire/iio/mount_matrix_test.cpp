#include "proofmass/acquire/iio/mount_matrix.hpp"

#include <gtest/gtest.h>

namespace proofmass::acquire::mount_matrix_test {
namespace {

TEST(MountMatrix, TurnsTheChipsAxesIntoTheBoards) {
  // The chip's y points along the board's x, its x opposite to the board's y.
  const auto matrix = parse_mount_matrix("0, 1, 0; -1, 0, 0; 0, 0, 1").value();
  ASSERT_TRUE(matrix);
  std::vector<double> x{1.0, 4.0}, y{2.0, 5.0}, z{3.0, 6.0};
  turn(*matrix, x, y, z);
  EXPECT_EQ(x, (std::vector<double>{2.0, 5.0}));
  EXPECT_EQ(y, (std::vector<double>{-1.0, -4.0}));
  EXPECT_EQ(z, (std::vector<double>{3.0, 6.0}));
}

TEST(MountMatrix, OfTheIdentityThereIsNothingToTurn) {
  EXPECT_FALSE(parse_mount_matrix("1, 0, 0; 0, 1, 0; 0, 0, 1\n").value());
}

TEST(MountMatrix, TakesThePrecisionOfADeviceTree) {
  EXPECT_TRUE(parse_mount_matrix("0.707,-0.707,0;0.707,0.707,0;0,0,1").value());
}

TEST(MountMatrix, RefusesWhatIsNoRotation) {
  for (const char* const text :
       {"", "1, 0, 0", "1 0 0 0 1 0 0 0 1", "1, 0, 0; 0, 1, 0; 0, 0, 1; 0",
        "0, 0, 0; 0, 0, 0; 0, 0, 0", "1, 0, 0; 0, 2, 0; 0, 0, 1", "1, 0, 0; 1, 0, 0; 0, 0, 1",
        "nan, 0, 0; 0, 1, 0; 0, 0, 1", "1, 0, 0; 0, 1, 0; 0, 0, x"})
    EXPECT_FALSE(parse_mount_matrix(text)) << text;
}

}  // namespace
}  // namespace proofmass::acquire::mount_matrix_test
