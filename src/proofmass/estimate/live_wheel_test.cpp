#include "proofmass/estimate/live_wheel.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/live_test_support.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::live_wheel_test {
namespace {

using test::Drive;
using test::Fed;
using test::feed;
using test::Followed;
using test::Mount;
using test::rpm;
using test::Stream;

const Drive even{{0.3, 20 * rpm}, {{20.0, 20 * rpm}}};

Stream stream_of(const std::vector<WheelSensor>& sensors) {
  Stream stream{sensors.front().time_s, {}};
  for (const WheelSensor& sensor : sensors)
    for (const auto& axis : sensor.accel_mps2) stream.channels.push_back(axis);
  for (const WheelSensor& sensor : sensors)
    for (const auto& axis : sensor.rate_radps)
      if (!axis.empty()) stream.channels.push_back(axis);
  return stream;
}

Stream one_sensor(const Drive& drive = even, double rate_hz = 100.0, std::uint64_t seed = 1) {
  Mount mount;
  mount.place_m = 0.1;
  mount.bias_mps2 = {0.1, -0.15};
  mount.noise_mps2 = 0.02;
  return stream_of({test::record(drive, mount, rate_hz, seed)});
}

LiveWheelOptions options_for(std::size_t sensors, std::optional<double> radius_m = 0.1) {
  LiveWheelOptions options;
  for (std::size_t s = 0; s < sensors; ++s)
    options.sensors.push_back({"acc" + std::to_string(s + 1), 3 * s, 3 * s + 1, 3 * s + 2});
  options.wheel.radius_m = radius_m;
  options.wheel.bandwidth_hz = 5000.0;  // the simulated measurements have no delay
  return options;
}

Followed follow(const Stream& stream, const LiveWheelOptions& options, std::size_t piece = 10) {
  return test::followed(live_wheel(options).value(), stream, piece);
}

/// Coverage of the truth (modulo turns) by the 95 % band, for the rows from `from_s` on.
double coverage(const Followed& run,
                const Drive& drive,
                double from_s,
                const std::string& what = "") {
  const auto& angle = run[what + "angle"];
  const auto& std = run[what + "angle_std"];
  const auto& time_s = what.empty() ? run.fed.rows.stamps_s : run["smoothed_time"];
  double held = 0.0, all = 0.0;
  for (std::size_t k = 0; k < angle.size(); ++k) {
    if (!(time_s[k] >= from_s)) continue;
    const double off = std::remainder(angle[k] - drive.at(time_s[k]).angle_rad, rad_per_turn);
    held += std::abs(off) < 1.96 * std[k] ? 1.0 : 0.0;
    all += 1.0;
  }
  return held / all;
}

TEST(LiveWheel, GivesTheSameRowsHoweverTheSamplesAreCut) {
  const Stream stream = one_sensor();
  const Followed whole = follow(stream, options_for(1), stream.stamps_s.size());
  ASSERT_GT(whole.fed.rows.rows(), 1900U);
  for (const std::size_t piece : {1U, 7U, 400U})
    EXPECT_TRUE(test::same(follow(stream, options_for(1), piece).fed.rows, whole.fed.rows))
        << piece;
}

TEST(LiveWheel, GivesARowForEverySampleOnceStartedInTheCallThatBringsIt) {
  const Stream stream = one_sensor();
  auto live = live_wheel(options_for(1)).value();
  Rows out;
  for (std::size_t k = 0; k < stream.stamps_s.size(); ++k) {
    (void)live->add(stream.block(k, 1), out).value();
    if (stream.stamps_s[k] < 5.5) continue;
    ASSERT_EQ(out.stamps_s.size(), k + 1);
    ASSERT_DOUBLE_EQ(out.stamps_s.back(), stream.stamps_s[k]);
  }
}

TEST(LiveWheel, ItsBandsHoldTheTruth) {
  const Followed one = follow(one_sensor(), options_for(1));
  EXPECT_GT(coverage(one, even, 4.0), 0.93);
  EXPECT_GT(coverage(one, even, 4.0, "smoothed_"), 0.93);
  double rms = 0.0;
  for (std::size_t k = 500; k < 2000; ++k)
    rms +=
        std::pow(std::remainder(one["angle"][k] - even.at(0.01 * static_cast<double>(k)).angle_rad,
                                rad_per_turn),
                 2) /
        1500.0;
  EXPECT_LT(std::sqrt(rms), 0.1 * rad_per_deg);
}

TEST(LiveWheel, AnUnknownBandwidthWidensTheAngleByWhatTheDelayMayTurnIt) {
  LiveWheelOptions unknown = options_for(1);
  unknown.wheel.bandwidth_hz.reset();
  const Followed known = follow(one_sensor(), options_for(1)), open = follow(one_sensor(), unknown);
  EXPECT_GT(open["angle_std"][1500], 2.0 * known["angle_std"][1500]);
  EXPECT_GT(coverage(open, even, 4.0), 0.93);
}

TEST(LiveWheel, TheLaggedAngleIsTheBetterOne) {
  const Followed one = follow(one_sensor(), options_for(1));
  const auto& filtered = one["angle_std"];
  const auto& lagged = one["smoothed_angle_std"];
  EXPECT_LT(lagged[1500], filtered[1500]);
  EXPECT_NEAR(one["smoothed_time"][1500], one.fed.rows.stamps_s[1500] - 0.25, 0.011);
  EXPECT_TRUE(std::isnan(lagged[10]));
}

TEST(LiveWheel, AgreesWithTheEstimateOfTheWholeRecording) {
  const Stream stream = one_sensor();
  WheelOptions options;
  options.radius_m = 0.1;
  WheelSensor sensor{
      "acc", stream.stamps_s, {stream.channels[0], stream.channels[1], stream.channels[2]}};
  const auto batch = estimate_wheel({sensor}, options).value();
  const Followed one = follow(stream, options_for(1));
  for (std::size_t k = 600; k < 2000; k += 50) {
    const double both = std::hypot(one["angle_std"][k], batch.series.filtered_angle_std_rad[k]);
    EXPECT_LT(std::abs(std::remainder(one["angle"][k] - batch.series.filtered_angle_rad[k],
                                      rad_per_turn)),
              4.0 * both)
        << "k = " << k;
  }
}

TEST(LiveWheel, TwoOppositeSensorsAreTakenTogether) {
  std::vector<WheelSensor> sensors;
  for (const double place_m : {0.1, -0.1}) {
    Mount mount;
    mount.place_m = place_m;
    mount.noise_mps2 = 0.02;
    mount.bias_mps2 = {place_m, 0.1};
    sensors.push_back(test::record(even, mount, 100.0, place_m > 0.0 ? 1 : 2));
  }
  const Followed both = follow(stream_of(sensors), options_for(2));
  EXPECT_GT(coverage(both, even, 5.0), 0.93);
  const Followed one = follow(one_sensor(), options_for(1));
  EXPECT_LT(both["angle_std"].back(), one["angle_std"].back());
}

TEST(LiveWheel, FollowsAWheelThatStartsFromRest) {
  const Drive drive{{0.4, 0.0}, {{6.0, 0.0}, {2.0, 2.0}, {12.0, 2.0}}};
  const Followed one = follow(one_sensor(drive), options_for(1));
  EXPECT_TRUE(one.fed.says("hardly turns yet"));
  EXPECT_GT(coverage(one, drive, 13.0), 0.9);
  EXPECT_NEAR((one["angle"].back() - one["angle"].front()) / rad_per_turn, drive.turns(0.0, 20.0),
              0.05);
}

// Gravity adds to a centripetal force of 1.5 g once a turn, beyond a range of 2 g.
TEST(LiveWheel, AnAccelerometerIsNotUsedAtTheEndOfItsRange) {
  const Drive drive{{0.4, 0.0}, {{5.0, 0.0}, {4.0, 12.0}, {15.0, 12.0}}};
  Stream stream = one_sensor(drive, 200.0);
  for (auto& axis : stream.channels)
    for (double& force : axis) force = std::clamp(force, -19.6, 19.6);
  const Followed one = follow(stream, options_for(1, std::nullopt));
  EXPECT_TRUE(one.fed.says("at the limit of its range"));
  EXPECT_GT(coverage(one, drive, 13.0), 0.93);
  EXPECT_NEAR((one["angle"].back() - one["angle"].front()) / rad_per_turn, drive.turns(0.0, 24.0),
              0.05);
}

/// A wheelchair's wheel that is pushed, on a floor that shakes it.
Stream pushed_with_gyroscope() {
  Mount mount;
  mount.place_m = 0.05;
  mount.noise_mps2 = 0.3;
  return stream_of({test::record_with_gyroscope(
      test::pushes(), mount, 200.0, {.rolling_radius_m = 0.3}, [](double) { return 0.0; })});
}

TEST(LiveWheel, AGyroscopeKeepsAWheelThatIsPushedByHand) {
  LiveWheelOptions options = options_for(1, std::nullopt);
  options.gyroscopes = {{"gyroscope", 3, 4, 5}};
  const Drive drive = test::pushes();
  const Followed one = follow(pushed_with_gyroscope(), options);
  EXPECT_FALSE(one.fed.says("turns may be lost"));
  EXPECT_GT(coverage(one, drive, 6.0), 0.93);
  EXPECT_NEAR((one["angle"].back() - one["angle"].front()) / rad_per_turn,
              drive.turns(0.0, drive.duration_s()), 0.02);
  EXPECT_LT(one["angle_std"].back(), 0.1);
}

TEST(LiveWheel, AGyroscopeIsNotUsedAtTheEndOfItsRange) {
  Stream stream = pushed_with_gyroscope();
  for (double& rate : stream.channels[5]) rate = std::min(rate, 6.0);
  LiveWheelOptions options = options_for(1, std::nullopt);
  options.gyroscopes = {{"gyroscope", 3, 4, 5}};
  const Followed one = follow(stream, options);
  EXPECT_TRUE(one.fed.says("at the limit of its range"));
  EXPECT_GT(coverage(one, test::pushes(), 6.0), 0.93);
}

TEST(LiveWheel, AGyroscopeThatMeasuresNothingIsNotUsed) {
  Stream stream = one_sensor();
  for (int axis = 0; axis < 3; ++axis)
    stream.channels.emplace_back(stream.stamps_s.size(), std::nan(""));
  LiveWheelOptions options = options_for(1);
  options.gyroscopes = {{"gyroscope", 3, 4, 5}};
  const Followed without = follow(one_sensor(), options_for(1)), with = follow(stream, options);
  EXPECT_TRUE(test::same(with.fed.rows, without.fed.rows));
}

TEST(LiveWheel, FastSamplesAreAveraged) {
  const Drive drive{{0.3, 20 * rpm}, {{8.0, 20 * rpm}}};
  const Followed one = follow(one_sensor(drive, 2000.0), options_for(1), 500);
  EXPECT_NEAR(static_cast<double>(one.fed.rows.rows()), 4000.0, 64.0);
  EXPECT_GT(coverage(one, drive, 4.0), 0.93);
}

TEST(LiveWheel, LeavesOutWhatNoAccelerometerCanHaveMeantAndSaysSo) {
  Stream stream = one_sensor();
  for (std::size_t k = 600; k < 2000; k += 37) stream.channels[k % 3][k] = std::nan("");
  for (std::size_t k = 601; k < 2000; k += 41) stream.channels[k % 3][k] = 1e30;
  stream.stamps_s[1000] = stream.stamps_s[998];
  const Followed one = follow(stream, options_for(1));
  EXPECT_GT(coverage(one, even, 4.0), 0.93);
  EXPECT_TRUE(one.fed.says("beyond 1000 g"));
  EXPECT_TRUE(one.fed.says("their time does not rise"));
}

/// Its speed swings between 5 and 8 rad/s.
Drive swinging() {
  Drive drive{{0.3, 5.0}, {}};
  for (int k = 0; k < 10; ++k) drive.stages.push_back({3.0, k % 2 == 0 ? 8.0 : 5.0});
  return drive;
}

/// Errors of the angle, whole turns included, or of the speed, in its standard deviations, from 6 s
/// on.
std::vector<double> errors_in_std(const Followed& run,
                                  const Drive& drive,
                                  const std::string& what) {
  std::vector<double> out;
  const double first = run["angle"].front() - drive.at(run.fed.rows.stamps_s.front()).angle_rad;
  const double turned = rad_per_turn * std::round(first / rad_per_turn);
  for (std::size_t k = 0; k < run.fed.rows.rows(); ++k) {
    const double time_s = run.fed.rows.stamps_s[k];
    if (time_s < 6.0) continue;
    const test::Turning now = drive.at(time_s);
    const double truth = what == "angle" ? now.angle_rad + turned : now.speed_radps;
    out.push_back(std::abs(run[what][k] - truth) / run[what + "_std"][k]);
  }
  return out;
}

double share_held(const Followed& run, const Drive& drive, const std::string& what) {
  const std::vector<double> errors = errors_in_std(run, drive, what);
  return static_cast<double>(std::ranges::count_if(errors, [](double e) { return e < 1.96; })) /
         static_cast<double>(errors.size());
}

double largest(const Followed& run, const Drive& drive, const std::string& what) {
  return std::ranges::max(errors_in_std(run, drive, what));
}

TEST(LiveWheel, RepeatedRowsOfAStuckLoggerAreNoMeasurements) {
  const Drive drive = swinging();
  Stream stream = one_sensor(drive);
  for (const std::size_t from : {1000U, 1800U})
    for (auto& axis : stream.channels)
      for (std::size_t k = from; k < from + 120; ++k) axis[k] = axis[from];
  const Followed one = follow(stream, options_for(1));
  EXPECT_TRUE(one.fed.says("the same as the one before"));
  EXPECT_GT(share_held(one, drive, "angle"), 0.93);
  EXPECT_GT(share_held(one, drive, "speed"), 0.93);
}

// A computer that is busy for 1.2 s stamps the rows of that time at once; the rows do not depend on
// how they are cut into blocks.
TEST(LiveWheel, RowsThatWereStampedLateCostNoTurn) {
  const Drive drive = swinging();
  Stream stream = one_sensor(drive);
  for (const std::size_t from : {1000U, 1800U})
    for (std::size_t k = from; k < from + 120; ++k)
      stream.stamps_s[k] = stream.stamps_s[from + 120] - 1e-4 * static_cast<double>(from + 120 - k);
  const Followed one = follow(stream, options_for(1));
  EXPECT_TRUE(one.fed.says("were stamped late"));
  EXPECT_FALSE(one.fed.says("turns may be lost"));
  EXPECT_GT(share_held(one, drive, "angle"), 0.93);
  EXPECT_LT(largest(one, drive, "angle"), 4.0);
  const Followed cut = follow(stream, options_for(1), 7);
  EXPECT_EQ(one["angle"], cut["angle"]);
}

TEST(LiveWheel, RepeatedRowsOfASensorWithoutNoiseAtRestAreMeasurements) {
  const Drive drive{{0.3, 5.0}, {{8.0, 5.0}, {2.0, 0.0}, {10.0, 0.0}}};
  Stream stream = one_sensor(drive);
  for (auto& axis : stream.channels)
    for (double& value : axis) value = 0.5 * std::round(value / 0.5);
  const Followed one = follow(stream, options_for(1));
  EXPECT_FALSE(one.fed.says("the same as the one before"));
  EXPECT_FALSE(one.fed.says("turns may be lost"));
}

// The acceleration before the gap does not last.
TEST(LiveWheel, TheTurnsAcrossAGapAreAsUncertainAsTheSpeedChanges) {
  const Drive drive = swinging();
  Stream stream = one_sensor(drive);
  constexpr std::size_t from = 1351, to = 1540;
  const auto cut = [](auto& values) { values.erase(values.begin() + from, values.begin() + to); };
  cut(stream.stamps_s);
  for (auto& axis : stream.channels) cut(axis);
  EXPECT_LT(largest(follow(stream, options_for(1)), drive, "angle"), 4.0);
}

/// A recording of a wheel on a bench.
Stream with_gyroscope(const Drive& drive, double rate_hz, double noise_mps2) {
  Mount mount;
  mount.place_m = 0.1;
  mount.bias_mps2 = {0.1, -0.15};
  mount.noise_mps2 = noise_mps2;
  return stream_of(
      {test::record_with_gyroscope(drive, mount, rate_hz, {}, [](double) { return 0.0; })});
}

// A gentle swing of the speed shows no rolling radius.
TEST(LiveWheel, AGyroscopeOnABenchKeepsTheAngle) {
  Drive drive{{0.3, 2.4}, {}};
  for (int k = 0; k < 12; ++k) drive.stages.push_back({5.0, k % 2 == 0 ? 3.2 : 2.4});
  LiveWheelOptions options = options_for(1, std::nullopt);
  options.gyroscopes = {{"gyroscope", 3, 4, 5}};
  const Followed one = follow(with_gyroscope(drive, 200.0, 0.1), options);
  EXPECT_GT(share_held(one, drive, "angle"), 0.93);
  EXPECT_GT(share_held(one, drive, "speed"), 0.93);
}

TEST(LiveWheel, SingleOutliersOfAllChannelsCostNoTurn) {
  LiveWheelOptions options = options_for(1, std::nullopt);
  options.gyroscopes = {{"gyroscope", 3, 4, 5}};
  const Drive drive = swinging();
  Stream stream = with_gyroscope(drive, 100.0, 0.05);
  test::Normal normal(7);
  for (std::size_t k = 700; k < stream.stamps_s.size(); k += 151)
    for (auto& axis : stream.channels) axis[k] += 120.0 * normal();
  EXPECT_LT(largest(follow(stream, options), drive, "angle"), 4.0);
}

TEST(LiveWheel, SearchesTheWheelAgainAfterALongGap) {
  Stream stream = one_sensor();
  for (std::size_t k = 1000; k < stream.stamps_s.size(); ++k) stream.stamps_s[k] += 60.0;
  const Followed one = follow(stream, options_for(1));
  EXPECT_TRUE(one.fed.says("turns may be lost"));
  const Drive later{{even.at(10.0).angle_rad - 60.0 * 20 * rpm - 10.0 * 20 * rpm, 20 * rpm},
                    {{80.0, 20 * rpm}}};
  EXPECT_GT(coverage(one, later, 75.0), 0.93);
}

TEST(LiveWheel, RestartsIfTheClockIsSetBack) {
  Stream stream = one_sensor();
  for (std::size_t k = 1000; k < stream.stamps_s.size(); ++k) stream.stamps_s[k] -= 9.0;
  const Followed one = follow(stream, options_for(1));
  EXPECT_TRUE(one.fed.says("the clock stepped back"));
  EXPECT_NEAR(one.fed.rows.stamps_s.back(), stream.stamps_s.back(), 1e-9);
}

TEST(LiveWheel, ReportsThatThereIsNoWheel) {
  Stream stream = one_sensor();
  test::Normal noise(3);
  for (auto& channel : stream.channels)
    for (double& value : channel) value = 20.0 * noise();
  const Followed one = follow(stream, options_for(1));
  EXPECT_EQ(one.fed.rows.rows(), 0U);
  EXPECT_TRUE(one.fed.says("no wheel found"));
}

TEST(LiveWheel, ReportsThatTheRadiusIsUnknown) {
  const Drive slow{{0.3, 11 * rpm}, {{12.0, 11 * rpm}}};
  const auto followed = follow(one_sensor(slow), options_for(1, std::nullopt));
  EXPECT_TRUE(followed.fed.says("angle is less certain"));
  EXPECT_TRUE(followed.fed.recommends("radius"));
}

TEST(LiveWheel, AStepAllocatesNothingOnceTheWheelIsFound) {
  // Two speeds at the start determine the lever arm, after which no data are collected any more.
  const Drive drive{{0.3, 5.0}, {{1.0, 5.0}, {2.0, 10.0}, {9.0, 10.0}}};
  const Stream stream = one_sensor(drive);
  auto live = live_wheel(options_for(1)).value();
  Rows out;
  (void)live->add(stream.block(0, 600), out).value();
  out.stamps_s.reserve(2000);
  for (auto& channel : out.channels) channel.reserve(2000);
  const Block later = stream.block(600, 600);
  (void)live->take_notes();
  const std::size_t before = test::allocations();
  const bool done = live->add(later, out).has_value();
  EXPECT_EQ(test::allocations(), before);
  EXPECT_TRUE(done);
}

TEST(LiveWheel, RefusesWhatItCannotUse) {
  EXPECT_FALSE(live_wheel({}));
  LiveWheelOptions no_y = options_for(1);
  no_y.sensors[0].y.reset();
  EXPECT_FALSE(live_wheel(no_y));
  LiveWheelOptions two_axes = options_for(1);
  two_axes.gyroscopes = {{"gyroscope", 3, 4, {}}};
  EXPECT_FALSE(live_wheel(two_axes));
  LiveWheelOptions one_of_two = options_for(2);
  one_of_two.gyroscopes = {{"gyroscope", 6, 7, 8}};
  EXPECT_FALSE(live_wheel(one_of_two));
  LiveWheelOptions lag = options_for(1);
  lag.lag_s = std::nan("");
  EXPECT_FALSE(live_wheel(lag));
  auto live = live_wheel(options_for(2)).value();
  Rows out;
  EXPECT_FALSE(live->add(one_sensor().block(0, 10), out)) << "three channels of six";
  Block timeless = one_sensor().block(0, 10);
  timeless.stamps_s = {};
  EXPECT_FALSE(live_wheel(options_for(1)).value()->add(timeless, out));
}

}  // namespace
}  // namespace proofmass::estimate::live_wheel_test
