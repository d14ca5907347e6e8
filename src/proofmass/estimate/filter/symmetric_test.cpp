#include "proofmass/estimate/filter/symmetric.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace proofmass::estimate::symmetric_test {
namespace {

TEST(Symmetric, KeepsItsLowerTriangleRowByRow) {
  Mat<3, 3> full;
  full << 1, 2, 4, 2, 3, 5, 4, 5, 6;
  const auto packed = Symmetric<3>::of(full);
  EXPECT_EQ(packed.lower, (std::array{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(packed.dense(), full);
  EXPECT_EQ(packed.diagonal(), Mat<3>(1, 3, 6));
}

TEST(Symmetric, AnEntryAndItsMirrorAreOne) {
  Symmetric<4> packed;
  packed(1, 3) = 7.0;
  EXPECT_EQ(packed(3, 1), 7.0);
  EXPECT_EQ(packed.dense()(1, 3), 7.0);
  EXPECT_EQ(packed.dense()(3, 1), 7.0);
}

TEST(PackedGaussian, IsNotDeterminedWhereItsVarianceIsInfinite) {
  PackedGaussian<2> x;
  x.cov(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(x.determined(0));
  EXPECT_FALSE(x.determined(1));
}

}  // namespace
}  // namespace proofmass::estimate::symmetric_test
