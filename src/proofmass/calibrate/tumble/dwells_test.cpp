#include "proofmass/calibrate/tumble/dwells.hpp"

#include <gtest/gtest.h>

#include "proofmass/core/units.hpp"

namespace proofmass::calibrate::tumble_dwells_test {
namespace {

/// Stops of `samples` samples every 15 degrees, with rotations of 30 samples between them.
std::vector<double> stopping(std::size_t stops, std::size_t samples) {
  constexpr std::size_t turn = 30;
  std::vector<double> angle;
  for (std::size_t k = 0; k < stops; ++k) {
    const double at_deg = 15.0 * static_cast<double>(k);
    for (std::size_t j = 0; j < samples; ++j) angle.push_back(at_deg * rad_per_deg);
    for (std::size_t j = 1; j <= turn; ++j)
      angle.push_back((at_deg + 15.0 * static_cast<double>(j) / turn) * rad_per_deg);
  }
  return angle;
}

TEST(StopsInPlaces, IsTrueOfARecordingOfStops) {
  EXPECT_TRUE(stops_in_places(stopping(6, 200), 100.0));
}

TEST(StopsInPlaces, IsTrueOfShortStopsBetweenLongTurns) {
  EXPECT_TRUE(stops_in_places(stopping(6, 60), 100.0));
}

TEST(StopsInPlaces, IsFalseOfATableOfPositions) {
  std::vector<double> angle;
  for (int k = 0; k < 360; ++k) angle.push_back(k * rad_per_deg);
  EXPECT_FALSE(stops_in_places(angle, 0.0));
  EXPECT_FALSE(stops_in_places(std::vector<double>(24, 0.0), 0.0));
}

}  // namespace
}  // namespace proofmass::calibrate::tumble_dwells_test
