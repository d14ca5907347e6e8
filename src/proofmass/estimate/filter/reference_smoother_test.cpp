#include <gtest/gtest.h>

#include "proofmass/estimate/filter/reference_cases_test_support.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate::reference_smoother_test {
namespace {

using test::Measured;
using test::worst_error;

// The first 15 seconds of the case that filter/reference_smoother_slow_test.cpp runs for 500 s.
constexpr std::size_t epochs = 3000;

TEST(AgainstOneHundredAndTwentyEightBits, SmoothedMeansFromAccelerationsAreRightToTwelveDigits) {
  const auto worst = worst_error({.epochs = epochs, .measured = Measured::acceleration});
  EXPECT_LT(worst.mean_stds, 1e-12);
  EXPECT_LT(worst.cov_share, 1e-11);
  EXPECT_LT(worst.lag_one_share, 1e-11);
}

TEST(AgainstOneHundredAndTwentyEightBits, MissingReadingsCostNoDigits) {
  const auto worst =
      worst_error({.epochs = epochs, .measured = Measured::acceleration, .missing = true});
  EXPECT_LT(worst.mean_stds, 1e-12);
  EXPECT_LT(worst.cov_share, 1e-11);
  EXPECT_LT(worst.lag_one_share, 1e-11);
}

TEST(AgainstOneHundredAndTwentyEightBits, SmoothedMeansFromPositionsAreRightToElevenDigits) {
  const auto worst = worst_error({.epochs = epochs, .measured = Measured::position});
  EXPECT_LT(worst.mean_stds, 1e-11);
  EXPECT_LT(worst.cov_share, 1e-11);
}

// The inverse costs a digit if position and velocity are not observable.
TEST(AgainstOneHundredAndTwentyEightBits, TheSmootherWithTheInverseIsRightToElevenDigits) {
  const auto worst = worst_error({.epochs = epochs,
                                  .measured = Measured::acceleration,
                                  .smoother = Smoother::rauch_tung_striebel});
  EXPECT_LT(worst.mean_stds, 1e-11);
  EXPECT_LT(worst.cov_share, 1e-11);
}

}  // namespace
}  // namespace proofmass::estimate::reference_smoother_test
