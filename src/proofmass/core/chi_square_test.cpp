#include "proofmass/core/chi_square.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::chi_square_test {
namespace {

// Tables of the chi-square distribution, and its closed form for two degrees of freedom.
TEST(ChiSquareQuantile, AgreesWithTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 10.0), 18.307, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.025, 1.0), 0.000982, 5e-7);
  EXPECT_NEAR(chi_square_quantile(0.9, 2.0), -2.0 * std::log(0.1), 1e-12);
}

TEST(ChiSquareP, IsWhatTheQuantileLeavesAbove) {
  EXPECT_NEAR(chi_square_p(18.307, 10.0), 0.05, 1e-5);
  EXPECT_NEAR(chi_square_p(100.0, 2.0) / std::exp(-50.0), 1.0, 1e-12);
  for (const double k : {1.0, 7.0, 1000.0})
    EXPECT_NEAR(chi_square_p(chi_square_quantile(0.3, k), k), 0.7, 1e-12);
  EXPECT_EQ(chi_square_p(0.0, 3.0), 1.0);
}

TEST(MeanChiSquare95, ClosesInOnOneWithTheRootOfTheCount) {
  const Bounds thousand = mean_chi_square_95(1000);
  EXPECT_NEAR(thousand.lower, 0.914, 5e-4);
  EXPECT_NEAR(thousand.upper, 1.090, 5e-4);
}

}  // namespace
TEST(StudentT, PutsATwentiethOutsideItsTabulatedBounds) {
  EXPECT_NEAR(student_t_p(2.570582, 5.0), 0.05, 1e-7);
  EXPECT_NEAR(student_t_p(-2.570582, 5.0), 0.05, 1e-7);
  EXPECT_EQ(student_t_p(0.0, 3.0), 1.0);
}

TEST(FisherF, HasTheTabulatedTail) {
  EXPECT_NEAR(fisher_f_p(3.325835, 5.0, 10.0), 0.05, 1e-6);
  EXPECT_NEAR(fisher_f_p(4.0, 1.0, 7.0), student_t_p(2.0, 7.0), 1e-12);  // t² is F of 1 and k
  EXPECT_EQ(fisher_f_p(0.0, 3.0, 4.0), 1.0);
}

}  // namespace proofmass::chi_square_test
