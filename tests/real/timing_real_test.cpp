// Clocks of published recordings.
#include <gtest/gtest.h>

#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::timing_real_test {
namespace {

TEST(PublishedClock, OfRowsInBurstsGivesTheRateOfTheLongRun) {
  // Half of the intervals are 2 ms (490 Hz), although there are 65 067 rows in 655.1 s.
  const auto folder = published_data() / "sunsided-mpu6050";
  for (const char* name :
       {"unmoved-with-x-pointing-forward-10min", "unmoved-with-x-pointing-forward",
        "unmoved-with-z-pointing-front-and-x-up", "unmoved-with-z-pointing-front-and-y-down"}) {
    const auto file = folder / name / "mpu6050_accelerometer.mat";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
    const auto read = io::read_recording(file, {});
    if (!read && read.error().code == Errc::unsupported) GTEST_SKIP() << read.error().message;
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_NEAR(read->time.rate_hz, 99.4, 0.2) << name;
  }
}

}  // namespace
}  // namespace proofmass::timing_real_test
