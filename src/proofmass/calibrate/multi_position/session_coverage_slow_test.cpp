#include <cstdio>
#include <gtest/gtest.h>

#include "proofmass/calibrate/session_noise_test_support.hpp"

// The table "Bias drift between rests" of docs/methods/calibration.md.
namespace proofmass::calibrate::session_coverage_slow_test {
namespace {

void expect_honest(const char* name, const test::Session& session, double most_z = 5.5) {
  const test::SessionCoverage found = test::coverage_of(session, 600);
  std::printf("%s: %.1f %.1f %.1f %%, largest %.1f, suspects %d\n", name, 100.0 * found.share(0),
              100.0 * found.share(1), 100.0 * found.share(2), found.largest_z, found.suspects);
  EXPECT_GE(found.fits, 594);
  EXPECT_LE(found.suspects, 12);
  EXPECT_LT(found.largest_z, most_z);
  for (std::size_t kind = 0; kind < 3; ++kind) {
    EXPECT_GT(found.share(kind), 0.92) << name << " " << kind;
    EXPECT_LE(found.share(kind), 0.995) << name << " " << kind;
  }
}

TEST(SessionCoverage, OfWhiteNoise) {
  expect_honest("white, 18", {});
  expect_honest("white, 30", {.positions = 30});
}

TEST(SessionCoverage, OfFlickerNoise) {
  expect_honest("flicker 0.5 mm/s^2", {.flicker_mps2 = 0.5e-3});
  expect_honest("flicker 3 mm/s^2", {.flicker_mps2 = 3e-3});
  expect_honest("flicker 6 mm/s^2", {.flicker_mps2 = 6e-3});
}

TEST(SessionCoverage, OfARandomWalk) {
  expect_honest("walk 0.1 mm/s^2/sqrt(s)", {.walk_mps2_rts = 1e-4});
  // In one of the 600 the error is 15 standard deviations: see the limits in that page.
  expect_honest("walk 1 mm/s^2/sqrt(s)", {.walk_mps2_rts = 1e-3}, 20.0);
}

}  // namespace
}  // namespace proofmass::calibrate::session_coverage_slow_test
