#include "proofmass/estimate/wheel/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/wheel/settle.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_doubts_test {
namespace {

/// A turning wheel at 100 Hz, and a fit whose smoothed angle is the true one.
struct Turning {
  static constexpr double rate_hz = 100.0, speed_radps = 3.0, duration_s = 20.0;
  WheelReadings readings;
  WheelFit fit;

  Turning() {
    readings.sensors.resize(1);
    test::Normal normal(1);
    PlanarReadings& sensor = readings.sensors[0];
    for (int k = 0; k < static_cast<int>(rate_hz * duration_s); ++k) {
      const double t = k / rate_hz, angle = speed_radps * t;
      readings.time_s.push_back(t);
      readings.epochs.push_back({k == 0 ? 0.0 : 1.0 / rate_hz, {k, WheelEpoch::no_row}});
      sensor.u_mps2.push_back(readings.gravity_mps2 * std::sin(angle) + 0.5 * normal());
      sensor.v_mps2.push_back(readings.gravity_mps2 * std::cos(angle) + 0.5 * normal());
      sensor.variance_m2ps4.push_back(0.25);
      fit.track.path.moving.emplace_back(angle, speed_radps, 0.0, 0.0);
    }
    fit.track.path.standing = Eigen::VectorXd::Zero(wheel::standing(1));
  }

  /// Lets the smoothed angle gain a turn.
  void slip(double from_s, double within_s) {
    for (std::size_t k = 0; k < readings.time_s.size(); ++k)
      fit.track.path.moving[k](wheel::angle) +=
          rad_per_turn * std::clamp((readings.time_s[k] - from_s) / within_s, 0.0, 1.0);
  }

  /// The doubts, if the predicted angle did not show gravity in the given seconds.
  std::vector<WheelDoubt> doubts(double from_s, double to_s) {
    std::vector<WheelDoubt> unseen;
    if (to_s > from_s)
      unseen.push_back(
          {static_cast<std::size_t>(from_s * rate_hz), static_cast<std::size_t>(to_s * rate_hz)});
    const auto model = held_model<1>(readings, {.jerk_psd = 1.0}, fit.track.path);
    doubt_smoothed(model, readings, Gaussian<wheel::states(1)>{}, unseen, fit);
    return fit.doubts;
  }
};

TEST(DoubtSmoothed, TrustsAnAngleThatShowsGravityThroughout) {
  EXPECT_TRUE(Turning().doubts(5.0, 5.5).empty());
}

TEST(DoubtSmoothed, SeesAnAngleThatSlips) {
  Turning slow;
  slow.slip(5.0, 1.0);
  const auto doubts = slow.doubts(0.0, 0.0);
  ASSERT_FALSE(doubts.empty());
  EXPECT_NEAR(slow.readings.time_s[doubts.front().first], 5.0, 0.6);
}

// A slip within 0.15 s is too short for windows of half a second.
TEST(DoubtSmoothed, KeepsADoubtAboutWhichTheAngleSlipsFast) {
  for (const double from_s : {4.7, 5.0, 5.22, 5.7}) {
    Turning fast;
    fast.slip(from_s, 0.15);
    const auto doubts = fast.doubts(5.0, 5.5);
    ASSERT_EQ(doubts.size(), 1U) << from_s;
    EXPECT_EQ(doubts.front().first, 500U);
    EXPECT_EQ(doubts.front().last, 550U);
  }
}

}  // namespace
}  // namespace proofmass::estimate::wheel_doubts_test
