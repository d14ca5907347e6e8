#include "proofmass/core/directions.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::directions_test {
namespace {

TEST(SpreadDirections, AreUnitVectorsAsManyAsAskedFor) {
  EXPECT_TRUE(spread_directions(0).empty());
  EXPECT_NEAR((spread_directions(1).front() - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-15);
  for (const std::size_t count : {2U, 9U, 24U, 500U}) {
    const auto directions = spread_directions(count);
    ASSERT_EQ(directions.size(), count);
    for (const Eigen::Vector3d& d : directions) EXPECT_NEAR(d.norm(), 1.0, 1e-15);
  }
}

// Uniform over the sphere: mean 0 and mean square 1/3 along every axis.
TEST(SpreadDirections, FavourNoAxis) {
  for (const std::size_t count : {24U, 1000U}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& d : spread_directions(count)) {
      sum += d;
      squares += d * d.transpose();
    }
    const double n = static_cast<double>(count);
    EXPECT_LT((sum / n).norm(), 1.0 / n);
    EXPECT_LT((squares / n - Eigen::Matrix3d::Identity() / 3.0).norm(), 1.0 / n);
  }
}

// The best packing of n caps has neighbours about √(8π/(√3 n)) apart; the spiral comes close.
TEST(SpreadDirections, KeepTheirDistance) {
  for (const std::size_t count : {12U, 24U, 100U, 400U}) {
    const auto d = spread_directions(count);
    double nearest = 2.0;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < i; ++k) nearest = std::min(nearest, (d[i] - d[k]).norm());
    const double best = std::sqrt(8.0 * 3.14159265 / (std::sqrt(3.0) * static_cast<double>(count)));
    EXPECT_GT(nearest, 0.7 * best) << count;
  }
}

}  // namespace
}  // namespace proofmass::directions_test
