#include "proofmass/acquire/stream/pacer.hpp"

#include <gtest/gtest.h>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire::pacer_test {
namespace {

using std::chrono::milliseconds;

TEST(Pacer, HasTheFirstRowDueAtOnce) {
  Pacer pacer(1.0);
  EXPECT_TRUE(pacer.wait_until(0, milliseconds(0)));
}

TEST(Pacer, NeverLetsARowGoBeforeItsTime) {
  Pacer pacer(1.0);
  (void)pacer.now_ns();
  for (std::int64_t time_ns = 0; time_ns < 20'000'000; time_ns += 1'300'000) {
    while (!pacer.wait_until(time_ns, milliseconds(1000))) continue;
    EXPECT_GE(pacer.now_ns(), time_ns);
  }
}

TEST(Pacer, GivesUpWhenPatienceEnds) {
  Pacer pacer(1.0);
  const std::int64_t began_ns = host_now_ns();
  EXPECT_FALSE(pacer.wait_until(std::int64_t{1} << 60, milliseconds(5)));
  EXPECT_GE(host_now_ns() - began_ns, 5'000'000);
}

TEST(Pacer, DividesTheWaitByTheSpeed) {
  Pacer pacer(1e6);
  const std::int64_t began_ns = host_now_ns();
  while (!pacer.wait_until(std::int64_t{3600} * 1'000'000'000, milliseconds(1000))) continue;
  EXPECT_GE(host_now_ns() - began_ns, 3'600'000);
}

TEST(Pacer, CountsFromItsFirstUse) {
  Pacer pacer(1e-3);
  EXPECT_EQ(pacer.now_ns(), 0);
}

TEST(Pacer, KeepsItsRangeAtAnySpeed) {
  Pacer pacer(1e300);
  (void)pacer.now_ns();
  const std::int64_t began_ns = host_now_ns();
  while (host_now_ns() == began_ns) continue;
  EXPECT_GT(pacer.now_ns(), 0);
}

}  // namespace
}  // namespace proofmass::acquire::pacer_test
