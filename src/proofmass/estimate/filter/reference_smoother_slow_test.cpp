#include <gtest/gtest.h>

#include "proofmass/estimate/filter/reference_cases_test_support.hpp"

namespace proofmass::estimate::reference_smoother_slow_test {
namespace {

using test::Measured;

// 500 seconds: five times the bias's time constant.
constexpr std::size_t epochs = 100'000;

TEST(AgainstOneHundredAndTwentyEightBits, AHundredThousandAccelerationsLoseNoDigits) {
  const auto worst = test::worst_error({.epochs = epochs, .measured = Measured::acceleration});
  EXPECT_LT(worst.mean_stds, 1e-12);
  EXPECT_LT(worst.cov_share, 1e-11);
}

TEST(AgainstOneHundredAndTwentyEightBits, AHundredThousandPositionsLoseNoDigits) {
  const auto worst = test::worst_error({.epochs = epochs, .measured = Measured::position});
  EXPECT_LT(worst.mean_stds, 1e-11);
  EXPECT_LT(worst.cov_share, 1e-11);
}

}  // namespace
}  // namespace proofmass::estimate::reference_smoother_slow_test
