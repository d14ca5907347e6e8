#include "proofmass/core/samples.hpp"

#include <gtest/gtest.h>

namespace proofmass::samples_test {
namespace {

TEST(Samples, AreSharedByCopiesUntilAChange) {
  Samples one{1.0, 2.0};
  const Samples other = one;
  EXPECT_EQ(one.data(), other.data());
  one.edit().push_back(3.0);
  EXPECT_EQ(one, Samples({1.0, 2.0, 3.0}));
  EXPECT_EQ(other, Samples({1.0, 2.0}));
}

TEST(Samples, AreNotCopiedForAChangeByTheOnlyOwner) {
  Samples samples{1.0, 2.0};
  const double* before = samples.data();
  samples.edit()[1] = 5.0;
  EXPECT_EQ(samples.data(), before);
  EXPECT_EQ(std::move(samples).take().data(), before);
}

TEST(Samples, LeaveSharedSamplesWhereTheyAreTaken) {
  Samples one{1.0, 2.0};
  const Samples other = one;
  EXPECT_EQ(std::move(one).take(), (std::vector{1.0, 2.0}));
  EXPECT_EQ(other, Samples({1.0, 2.0}));
}

TEST(Samples, KeepTheOwnerOfBorrowedMemoryAndNeverChangeIt) {
  const auto owner = std::make_shared<const std::vector<double>>(3, 1.0);
  {
    Samples samples = Samples::borrowed(*owner, owner);
    EXPECT_EQ(samples.data(), owner->data());
    EXPECT_EQ(owner.use_count(), 2);
    Samples copy = samples;
    copy.edit()[0] = 7.0;
    EXPECT_EQ(copy[0], 7.0);
    EXPECT_EQ(samples[0], 1.0);
    EXPECT_EQ(std::move(samples).take(), *owner);
  }
  EXPECT_EQ(owner.use_count(), 1);
  EXPECT_EQ(*owner, std::vector<double>(3, 1.0));
}

TEST(Samples, AreEmptyAfterAMove) {
  const auto owner = std::make_shared<const std::vector<double>>(3, 1.0);
  Samples own{1.0};
  Samples borrowed = Samples::borrowed(*owner, owner);
  const Samples moved = std::move(own), moved_too = std::move(borrowed);
  EXPECT_TRUE(own.empty());       // NOLINT(bugprone-use-after-move)
  EXPECT_TRUE(borrowed.empty());  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(moved.size() + moved_too.size(), 4U);
}

}  // namespace
}  // namespace proofmass::samples_test
