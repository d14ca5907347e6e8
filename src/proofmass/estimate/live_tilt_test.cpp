#include "proofmass/estimate/live_tilt.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/live_test_support.hpp"
#include "proofmass/estimate/tilt_test_support.hpp"

namespace proofmass::estimate::live_tilt_test {
namespace {

using test::Fed;
using test::feed;
using test::Followed;
using test::Stream;

Stream stream_of(const TiltRecord& record) {
  Stream stream{record.time_s, {}};
  for (const auto& axis : record.accel_mps2) stream.channels.push_back(axis);
  for (const auto& axis : record.rate_radps)
    if (!axis.empty()) stream.channels.push_back(axis);
  return stream;
}

LiveTiltOptions options_for(const TiltRecord& record) {
  LiveTiltOptions options;
  options.accelerometer = {"acc", 0, 1, 2};
  if (!record.rate_radps[0].empty()) options.gyroscope = Triad{"gyr", 3, 4, 5};
  options.tilt.bias_std_mps2 = 0.0;
  return options;
}

Followed follow(const TiltRecord& record, const LiveTiltOptions& options, std::size_t piece = 10) {
  return test::followed(live_tilt(options).value(), stream_of(record), piece);
}

/// Coverage of the pitch by the 95 % band, for the rows from two seconds on.
double coverage(const Followed& followed, const MovingBase& base, const std::string& what = "") {
  double held = 0.0, all = 0.0;
  for (std::size_t k = 200; k < followed.fed.rows.rows(); ++k) {
    const double time_s =
        what.empty() ? followed.fed.rows.stamps_s[k] : followed["smoothed_time"][k];
    const auto at = static_cast<std::size_t>(std::lround(100.0 * time_s));
    const double off = followed[what + "pitch"][k] - base.pitch_rad[at];
    held += std::abs(off) < 1.96 * followed[what + "pitch_std"][k] ? 1.0 : 0.0;
    all += 1.0;
  }
  return held / all;
}

TEST(LiveTilt, GivesTheSameRowsHoweverTheSamplesAreCut) {
  const MovingBase base = moving_base({.samples = 800}, 1);
  const Followed whole = follow(base.record, options_for(base.record), 800);
  ASSERT_EQ(whole.fed.rows.rows(), 800U);
  for (const std::size_t piece : {1U, 7U, 300U})
    EXPECT_TRUE(
        test::same(follow(base.record, options_for(base.record), piece).fed.rows, whole.fed.rows))
        << piece;
}

TEST(LiveTilt, ItsBandsHoldTheTruthInMotion) {
  for (const bool gyroscope : {true, false}) {
    const MovingBase base =
        moving_base({.samples = 3000, .accel_std_mps2 = 0.3, .gyroscope = gyroscope}, 2);
    const Followed followed = follow(base.record, options_for(base.record));
    EXPECT_GT(coverage(followed, base), 0.92) << gyroscope;
    EXPECT_GT(coverage(followed, base, "smoothed_"), 0.92) << gyroscope;
  }
}

TEST(LiveTilt, BandsHoldHoweverStrongTheBaseTurnsWithoutGyroscope) {
  for (const double turning_radps2_rthz : {0.1, 0.5, 1.0}) {
    double held = 0.0;
    constexpr int runs = 30;
    for (int seed = 1; seed <= runs; ++seed) {
      const MovingBase base =
          moving_base({.angular_accel_radps2_rthz = turning_radps2_rthz, .gyroscope = false},
                      static_cast<std::uint64_t>(seed));
      held += coverage(follow(base.record, options_for(base.record)), base) / runs;
    }
    EXPECT_GE(held, 0.93) << turning_radps2_rthz;
  }
}

// From the first row on, and without errors of many standard deviations.
TEST(LiveTilt, BandsHoldUnderALevelAccelerationWithoutGyroscope) {
  for (const double fastest_hz : {0.2, 3.0}) {
    int held = 0, all = 0;
    double largest = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const MovingBase base = moving_base({.samples = 3000,
                                           .accel_std_mps2 = 0.0,
                                           .sway_mps2 = 1.0,
                                           .slowest_sway_hz = 0.2,
                                           .fastest_sway_hz = fastest_hz,
                                           .turning = 0.0,
                                           .reading_std_mps2 = 0.02,
                                           .gyroscope = false},
                                          seed);
      const Followed followed = follow(base.record, options_for(base.record));
      for (std::size_t k = 0; k < followed.fed.rows.rows(); k += 50) {
        const double z =
            std::abs(followed["pitch"][k] - base.pitch_rad[k]) / followed["pitch_std"][k];
        held += z < 1.96 ? 1 : 0;
        ++all;
        largest = std::max(largest, z);
      }
    }
    EXPECT_GE(static_cast<double>(held) / all, 0.93) << fastest_hz;
    EXPECT_LT(largest, 6.0) << fastest_hz;
  }
}

// Vibration of 0.3 m/s² begins with the rotation: the noise of the first second is not that of the
// motion.
TEST(LiveTilt, VibrationThatBeginsAfterARestIsNotRotation) {
  TiltRecord record;
  std::vector<double> pitch_rad;
  Random random(21, "from rest");
  for (int k = 0; k < 6000; ++k) {
    const double t = 0.01 * k, on = std::clamp((t - 5.0) / 1.0, 0.0, 1.0);
    pitch_rad.push_back(on * (0.1 * std::sin(4.0 * t) + 0.2 * std::sin(2.1 * t)));
    const Mat<3> f =
        force_at(on * (0.3 * std::sin(1.7 * t) + 0.1 * std::sin(5.1 * t)), pitch_rad.back());
    record.time_s.push_back(t);
    for (int i = 0; i < 3; ++i)
      record.accel_mps2[static_cast<std::size_t>(i)].push_back(f(i) +
                                                               (0.01 + 0.3 * on) * random.normal());
  }
  const Followed followed = follow(record, options_for(record));
  double squares = 0.0, largest = 0.0;
  for (std::size_t k = 800; k < pitch_rad.size(); ++k) {
    const double z = (followed["pitch"][k] - pitch_rad[k]) / followed["pitch_std"][k];
    squares += z * z / static_cast<double>(pitch_rad.size() - 800);
    largest = std::max(largest, std::abs(z));
  }
  EXPECT_LT(squares, 1.3);
  EXPECT_LT(largest, 5.0);
}

TEST(LiveTilt, ASlowAccelerationBesideVibrationIsNotTilt) {
  int inside = 0, all = 0;
  for (unsigned seed = 61; seed < 66; ++seed) {
    const MovingBase base = slowly_swayed_base(0.3, seed);
    const Followed followed = follow(base.record, options_for(base.record));
    for (std::size_t k = 800; k < base.pitch_rad.size(); k += 50, ++all)
      inside += std::abs(followed["pitch"][k] - base.pitch_rad[k]) < 1.96 * followed["pitch_std"][k]
                    ? 1
                    : 0;
  }
  EXPECT_GT(inside, 0.9 * all);
}

TEST(LiveTilt, TheGyroscopeHelpsWhereTheBaseIsShaken) {
  const auto std_of = [](bool gyroscope) {
    const MovingBase base =
        moving_base({.samples = 2000, .accel_std_mps2 = 1.0, .gyroscope = gyroscope}, 3);
    return follow(base.record, options_for(base.record))["pitch_std"].back();
  };
  EXPECT_LT(std_of(true), 0.7 * std_of(false));
}

TEST(LiveTilt, AtRestItConvergesToGravity) {
  const TiltRecord record = still_record(force_at(0.3, -0.2), 0.02, 2000, 4);
  const Followed followed = follow(record, options_for(record));
  EXPECT_NEAR(followed["roll"].back(), 0.3, 3.0 * followed["roll_std"].back());
  EXPECT_NEAR(followed["pitch"].back(), -0.2, 3.0 * followed["pitch_std"].back());
  EXPECT_LT(followed["pitch_std"].back(), 0.2 * rad_per_deg);
  EXPECT_LT(followed["smoothed_pitch_std"].back(), followed["pitch_std"].back());
}

TEST(LiveTilt, StatesTheAccuracyOfAnUncalibratedSensor) {
  const TiltRecord record = still_record(force_at(0.3, -0.2), 0.02, 2000, 8);
  LiveTiltOptions options = options_for(record);
  options.tilt.bias_std_mps2.reset();
  const Followed followed = follow(record, options);
  EXPECT_GT(followed["pitch_std"].back(), 1.0 * rad_per_deg);
  EXPECT_LT(followed["pitch_std"].back(), 2.0 * rad_per_deg);
  EXPECT_TRUE(followed.fed.says("calibration is unknown"));
}

TEST(LiveTilt, MissingMeasurementsWidenTheBandAndAreReported) {
  MovingBase base = moving_base({.samples = 1000}, 5);
  for (std::size_t k = 500; k < 550; ++k) base.record.accel_mps2[1][k] = std::nan("");
  const Followed followed = follow(base.record, options_for(base.record));
  EXPECT_GT(followed["pitch_std"][549], followed["pitch_std"][499]);
  EXPECT_TRUE(std::isnan(followed["nis"][520]));
  EXPECT_TRUE(followed.fed.says("50 measurements excluded") ||
              followed.fed.says("10 measurements excluded"));
  EXPECT_GT(coverage(followed, base), 0.92);
}

// The rotation before a gap goes on through it in the model.
TEST(LiveTilt, AfterAGapWithoutGyroscopeTheDirectionIsTheMeasuredOne) {
  const auto roll = [](double t) { return 0.4 * std::sin(1.9 * t) + 0.3 * std::sin(0.7 * t); };
  const auto pitch = [](double t) { return 0.4 * std::sin(1.3 * t + 1.0); };
  TiltRecord record;
  Random random(8, "noise");
  for (int k = 0; k < 6000; ++k) {
    const double t = 0.01 * k, in_ten = std::fmod(t, 10.0);
    if (t > 10.0 && in_ten < 2.7) continue;
    const Mat<3> force = force_at(roll(t), pitch(t));
    record.time_s.push_back(t);
    for (std::size_t i = 0; i < 3; ++i)
      record.accel_mps2[i].push_back(force(static_cast<Eigen::Index>(i)) + 0.02 * random.normal());
  }
  const Followed followed = follow(record, options_for(record));
  double largest = 0.0;
  for (std::size_t k = 800; k < followed.fed.rows.rows(); ++k) {
    const double t = followed.fed.rows.stamps_s[k];
    largest = std::max({largest, std::abs(followed["roll"][k] - roll(t)) / followed["roll_std"][k],
                        std::abs(followed["pitch"][k] - pitch(t)) / followed["pitch_std"][k]});
  }
  EXPECT_LT(largest, 5.0);
}

TEST(LiveTilt, WithoutGravityInTheReadingsItSaysSo) {
  const TiltRecord record = still_record(force_at(0.3, -0.2, 1.0), 0.02, 300, 6);
  EXPECT_TRUE(follow(record, options_for(record)).fed.says("gravity was removed"));
}

TEST(LiveTilt, AStepAllocatesNothing) {
  const MovingBase base = moving_base({.samples = 1000}, 7);
  const Stream stream = stream_of(base.record);
  auto live = live_tilt(options_for(base.record)).value();
  Rows out;
  (void)live->add(stream.block(0, 300), out).value();
  out.stamps_s.reserve(2000);
  for (auto& channel : out.channels) channel.reserve(2000);
  const Block later = stream.block(300, 600);
  const std::size_t before = test::allocations();
  const bool done = live->add(later, out).has_value();
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(done);
}

TEST(LiveTilt, RefusesTwoAxes) {
  LiveTiltOptions options;
  options.accelerometer = {"acc", 0, 1, std::nullopt};
  EXPECT_FALSE(live_tilt(options));
}

}  // namespace
}  // namespace proofmass::estimate::live_tilt_test
