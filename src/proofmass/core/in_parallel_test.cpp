#include "proofmass/core/in_parallel.hpp"

#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

namespace proofmass::in_parallel_test {
namespace {

TEST(InParallel, DoesEachPartOnceWhateverTheirNumber) {
  for (const std::size_t parts : {0U, 1U, 2U, 100U}) {
    std::vector<int> done(parts, 0);
    in_parallel(parts, {}, [&](std::size_t k, const Progress&) { ++done[k]; });
    EXPECT_EQ(done, std::vector<int>(parts, 1));
  }
}

TEST(InParallel, TellsTheMeanOfTheParts) {
  double last = -1.0;
  in_parallel(
      4, [&](std::string_view, double fraction) { last = fraction; },
      [](std::size_t, const Progress& own) { own("", 1.0); });
  EXPECT_EQ(last, 1.0);
}

TEST(InParallel, DoesTheOthersAndThrowsWhatTheFirstOfTheFailedThrew) {
  std::vector<int> done(10, 0);
  try {
    in_parallel(10, {}, [&](std::size_t k, const Progress&) {
      ++done[k];
      if (k == 3) throw std::runtime_error("three");
      if (k == 7) throw std::runtime_error("seven");
    });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "three");
  }
  EXPECT_EQ(done, std::vector<int>(10, 1));
}

TEST(RunTasks, DoesEachOnceForFewSamplesAndForMany) {
  for (const std::size_t samples : {std::size_t{10}, std::size_t{1} << 20}) {
    std::vector<int> done(3, 0);
    run_tasks(samples, {[&] { ++done[0]; }, [&] { ++done[1]; }, [&] { ++done[2]; }});
    EXPECT_EQ(done, std::vector<int>(3, 1));
  }
}

}  // namespace
}  // namespace proofmass::in_parallel_test
