#include "proofmass/estimate/wheel.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proofmass/estimate/wheel_test_support.hpp"

// Whole recordings, short ones: what goes in is made by the kinematics of wheel_test_support.hpp.
namespace proofmass::estimate::wheel_test {
namespace {

using test::Drive;
using test::Mount;
using test::record;
using test::rpm;

WheelSolution solve(const std::vector<WheelSensor>& sensors, const WheelOptions& options = {}) {
  auto solution = estimate_wheel(sensors, options);
  EXPECT_TRUE(solution.has_value()) << solution.error().message;
  return std::move(solution).value();
}

/// The defaults but for one thing.
template <class Member, class Value>
WheelOptions with(Member member, Value value) {
  WheelOptions options;
  options.*member = value;
  return options;
}

bool any_says(const std::vector<std::string>& sentences, std::string_view part) {
  return std::ranges::any_of(sentences, [&](const std::string& sentence) {
    return sentence.find(part) != std::string::npos;
  });
}

/// Every number of the series that is promised to be one.
void expect_finite(const WheelSolution& solution) {
  const WheelSeries& s = solution.series;
  for (const auto* column :
       {&s.time_s, &s.angle_rad, &s.angle_std_rad, &s.speed_radps, &s.speed_std_radps,
        &s.accel_radps2, &s.accel_std_radps2, &s.filtered_angle_rad, &s.filtered_angle_std_rad}) {
    EXPECT_EQ(column->size(), s.time_s.size());
    EXPECT_TRUE(std::ranges::all_of(*column, [](double x) { return std::isfinite(x); }));
  }
}

/// The turns are right to `within` and within four of their own standard deviations.
void expect_turns(const WheelSolution& solution, double turns, double within) {
  ASSERT_TRUE(solution.turns.has_value());
  EXPECT_NEAR(solution.turns->value, turns, within);
  EXPECT_LT(std::abs(solution.turns->value - turns), 4.0 * solution.turns->std);
  EXPECT_GT(solution.turns->std, 0.0);
  EXPECT_LT(solution.turns->std, within);
  expect_finite(solution);
}

struct Trip {
  const char* name;
  Drive drive;
};

class WheelTrip : public testing::TestWithParam<Trip> {};

TEST_P(WheelTrip, IsFollowedByOneSensor) {
  const Drive& drive = GetParam().drive;
  Mount mount;
  mount.bias_mps2 = {0.2, -0.15};
  // Sensors without a filter; otherwise turns that end at another speed are less sure.
  const auto solution =
      solve({record(drive, mount, 60.0, 7)}, with(&WheelOptions::bandwidth_hz, 1e4));
  expect_turns(solution, drive.turns(0.0, solution.series.time_s.back()), 0.004);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    WheelTrip,
    testing::Values(
        Trip{"forwards", {{0.3, 0.0}, {{1.0, 0.0}, {3.0, 60 * rpm}, {3.0, 0.0}, {1.0, 0.0}}}},
        Trip{"backwards", {{-2.0, 0.0}, {{1.0, 0.0}, {3.0, -60 * rpm}, {3.0, 0.0}, {1.0, 0.0}}}},
        Trip{"there and back", {{1.0, 0.0}, {{2.0, 50 * rpm}, {2.0, -50 * rpm}, {2.0, 0.0}}}},
        Trip{"stop and start",
             {{0.0, 0.0}, {{2.0, 60 * rpm}, {2.0, 0.0}, {2.0, 0.0}, {2.0, 80 * rpm}}}},
        Trip{"already at speed", {{2.5, 100 * rpm}, {{3.0, 100 * rpm}, {3.0, 40 * rpm}}}}),
    [](const auto& trip) {
      std::string name = trip.param.name;
      std::ranges::replace(name, ' ', '_');
      return name;
    });

const Drive lively{{0.3, 0.0}, {{1.0, 0.0}, {3.0, 90 * rpm}, {3.0, 30 * rpm}, {2.0, 0.0}}};

TEST(EstimateWheel, OfASensorNearTheAxleAndOneAtTheRimCountsTheSameTurns) {
  for (const double radius_m : {0.008, 0.3}) {
    Mount mount;
    mount.place_m = std::polar(radius_m, 0.7);
    const auto solution = solve({record(lively, mount, 60.0, 3)});
    expect_turns(solution, lively.turns(0.0, solution.series.time_s.back()), 0.004);
  }
}

TEST(EstimateWheel, FindsRadiusMountingBiasAndScaleWhereTheSpeedChanges) {
  Mount mount;
  mount.place_m = std::polar(0.15, 0.7);
  mount.turned_rad = 0.2;
  mount.bias_mps2 = {0.25, -0.1};
  mount.scale = {1.02, 0.99};
  const auto solution = solve({record(lively, mount, 60.0, 4)});
  const WheelSensorFit& fit = solution.sensors[0];
  ASSERT_TRUE(fit.radius_m && fit.mounting_rad && fit.bias_mps2[0] && fit.bias_mps2[1]);
  EXPECT_NEAR(fit.radius_m->value, 0.15, 4.0 * fit.radius_m->std);
  EXPECT_LT(fit.radius_m->std, 0.01);
  // The place is 0.7 − 0.2 ahead of the sensor's first axis, so that is 0.5 behind the spoke.
  EXPECT_NEAR(fit.mounting_rad->value, -0.5, 4.0 * fit.mounting_rad->std);
  EXPECT_NEAR(fit.bias_mps2[0]->value, 0.25, 4.0 * fit.bias_mps2[0]->std);
  EXPECT_NEAR(fit.bias_mps2[1]->value, -0.1, 4.0 * fit.bias_mps2[1]->std);
  ASSERT_TRUE(fit.scale[0] && fit.scale[1]);
  EXPECT_NEAR(fit.scale[0]->value, 1.02, 4.0 * fit.scale[0]->std);
  EXPECT_NEAR(fit.scale[1]->value, 0.99, 4.0 * fit.scale[1]->std);
  EXPECT_FALSE(any_says(solution.not_observable, "record a second speed"));
}

// b_u + ω² r is one number at one speed, whatever the speed is.
TEST(EstimateWheel, AtOneSpeedSaysThatTheRadiusNeedsASecond) {
  for (const double speed : {11 * rpm, 40 * rpm}) {
    const Drive steady{{0.3, speed}, {{12.0, speed}}};
    const auto solution = solve({record(steady, {}, 60.0, 5)});
    EXPECT_TRUE(any_says(solution.not_observable, "record a second speed")) << speed;
    EXPECT_FALSE(any_says(solution.not_observable, "at least one whole turn")) << speed;
    expect_turns(solution, steady.turns(0.0, 12.0), 0.004);
  }
}

TEST(EstimateWheel, ARadiusThatDoesNotShowIsNotMadeUp) {
  const Drive slow{{0.3, 11 * rpm}, {{12.0, 11 * rpm}}};
  const auto solution = solve({record(slow, {}, 60.0, 5)});
  EXPECT_FALSE(solution.sensors[0].radius_m.has_value());
  EXPECT_FALSE(solution.distance_m.has_value());
  EXPECT_FALSE(solution.double_integration.turns.has_value());
  EXPECT_NE(solution.double_integration.note, "");
}

TEST(EstimateWheel, ARadiusThatIsGivenIsTakenAndADirectionThatDoesNotShowIsNot) {
  const Drive steady{{0.3, 40 * rpm}, {{8.0, 40 * rpm}}};
  Mount mount;
  mount.bias_mps2 = {0.2, 0.0};
  const auto solution = solve({record(steady, mount, 60.0, 5)}, with(&WheelOptions::radius_m, 0.1));
  ASSERT_TRUE(solution.sensors[0].radius_m.has_value());
  EXPECT_NEAR(solution.sensors[0].radius_m->value, 0.1, 0.005);
  EXPECT_FALSE(solution.sensors[0].mounting_rad.has_value());
  EXPECT_FALSE(solution.sensors[0].bias_mps2[0].has_value());
  EXPECT_TRUE(any_says(solution.not_observable, "record a second speed"));
  ASSERT_TRUE(solution.distance_m.has_value());
  EXPECT_NEAR(solution.distance_m->value, 0.1 * 40 * rpm * 8.0, 4.0 * solution.distance_m->std);
}

TEST(EstimateWheel, OfAnOppositePairFindsPhaseAndAgreesWithEachAlone) {
  Mount one, two;
  one.bias_mps2 = {0.2, -0.3};
  two.place_m = {-0.1, 0.0};
  two.turned_rad = 0.1;
  two.bias_mps2 = {-0.25, 0.1};
  const WheelSensor first = record(lively, one, 60.0, 6), second = record(lively, two, 60.0, 7);
  const auto pair = solve({first, second});
  expect_turns(pair, lively.turns(0.0, pair.series.time_s.back()), 0.006);
  ASSERT_EQ(pair.sensors.size(), 2U);
  ASSERT_TRUE(pair.sensors[1].phase_rad.has_value());
  EXPECT_NEAR(pair.sensors[1].phase_rad->value, 0.1,
              std::max(4.0 * pair.sensors[1].phase_rad->std, 1e-3));
  for (const WheelSensor& alone : {first, second}) {
    const auto single = solve({alone});
    ASSERT_TRUE(single.turns && pair.turns);
    EXPECT_LT(std::abs(single.turns->value - pair.turns->value),
              3.0 * std::hypot(single.turns->std, pair.turns->std));
  }
}

TEST(EstimateWheel, AlignsTwoClocks) {
  Mount two;
  two.place_m = {-0.1, 0.0};
  two.clock_offset_s = 123.456;
  const auto solution = solve({record(lively, {}, 60.0, 6), record(lively, two, 60.0, 7)},
                              with(&WheelOptions::clocks_shared, false));
  ASSERT_TRUE(solution.sensors[1].clock_offset_s.has_value());
  EXPECT_NEAR(solution.sensors[1].clock_offset_s->value, 123.456, 2e-3);
  expect_turns(solution, lively.turns(0.0, 9.0), 0.01);
}

TEST(EstimateWheel, SeesTheSecondSensorFromTheSameSideOfTheWheel) {
  Mount back;
  back.place_m = {0.0, 0.12};
  back.axes = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};  // mounted on the wheel's other face
  const auto solution = solve({record(lively, {}, 60.0, 6), record(lively, back, 60.0, 7)});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.004);
  EXPECT_NEAR(solution.sensors[1].spin_axis[2], -1.0, 1e-3);
}

TEST(EstimateWheel, ATwoAxisSensorWillDo) {
  Mount mount;
  mount.two_axes = true;
  const auto solution = solve({record(lively, mount, 60.0, 8)});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.004);
}

TEST(EstimateWheel, AnUnknownDelayCostsTurnsOnlyWhereTheSpeedChanges) {
  const Drive to_rest{{0.3, 0.0}, {{1.0, 0.0}, {3.0, 90 * rpm}, {3.0, 0.0}, {1.0, 0.0}}};
  const Drive at_speed{{0.3, 0.0}, {{1.0, 0.0}, {3.0, 90 * rpm}, {4.0, 90 * rpm}}};
  const auto turns_std = [](const Drive& drive, const WheelOptions& options) {
    return solve({record(drive, {}, 60.0, 8)}, options).turns->std;
  };
  const WheelOptions known = with(&WheelOptions::bandwidth_hz, 50.0);
  EXPECT_LT(2.0 * turns_std(to_rest, {}), turns_std(at_speed, {}));
  EXPECT_GT(turns_std(at_speed, {}), 3.0 * turns_std(at_speed, known));
}

// Measurements of a pole at 20 Hz, by its differential equation at 60 kHz.
TEST(EstimateWheel, ABandwidthThatIsGivenTakesTheDelayOutOfTheAngle) {
  const Drive steady{{0.3, 60 * rpm}, {{8.0, 60 * rpm}}};
  Mount mount;
  mount.noise_mps2 = 0.0;
  constexpr int each = 1000;
  const WheelSensor fine = record(steady, mount, 60.0 * each, 1);
  test::Normal normal(3);
  WheelSensor sensor;
  sensor.name = "late";
  std::array<double, 3> state{};
  const double share = 1.0 - std::exp(-rad_per_turn * 20.0 / (60.0 * each));
  for (std::size_t k = 0; k < fine.time_s.size(); ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double now = fine.accel_mps2[axis][k];
      state[axis] = k == 0 ? now : state[axis] + share * (now - state[axis]);
    }
    if (k % each != 0 || k < 10 * each) continue;
    sensor.time_s.push_back(fine.time_s[k]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      sensor.accel_mps2[axis].push_back(state[axis] + 0.01 * normal());
  }
  const auto late_by = [&](const WheelOptions& options) {
    const auto solution = solve({sensor}, options);
    const double truth = steady.at(solution.series.time_s.back()).angle_rad;
    return Uncertain{std::remainder(solution.angle_final_rad->value - truth, rad_per_turn),
                     solution.angle_final_rad->std};
  };
  const Uncertain known = late_by(with(&WheelOptions::bandwidth_hz, 20.0)), unknown = late_by({});
  EXPECT_LT(std::abs(known.value), 0.005);  // ω τ is 50 mrad
  EXPECT_LT(known.std, 0.01);
  EXPECT_LT(std::abs(unknown.value), 2.0 * unknown.std);
  EXPECT_GT(unknown.std, 0.01);
}

TEST(EstimateWheel, AGyroscopeIsCalibratedByTheTurnsThatGravityCounts) {
  const Drive drive{{0.3, 0.0}, {{2.0, 0.0}, {4.0, 90 * rpm}, {20.0, 90 * rpm}, {4.0, 0.0}}};
  WheelSensor sensor = record(drive, {}, 60.0, 8);
  test::Normal normal(5);
  for (const double t : sensor.time_s) {
    sensor.rate_radps[0].push_back(0.01 * normal());
    sensor.rate_radps[1].push_back(0.01 * normal());
    sensor.rate_radps[2].push_back(1.015 * drive.at(t).speed_radps + 0.02 + 0.01 * normal());
  }
  const auto solution = solve({sensor});
  expect_turns(solution, drive.turns(0.0, solution.series.time_s.back()), 0.01);
  const WheelSensorFit& fit = solution.sensors[0];
  ASSERT_TRUE(fit.gyro_scale && fit.gyro_bias_radps);
  EXPECT_NEAR(fit.gyro_scale->value, 1.015, 3.0 * fit.gyro_scale->std);
  EXPECT_LT(fit.gyro_scale->std, 0.02);
  EXPECT_NEAR(fit.gyro_bias_radps->value, 0.02, 3.0 * fit.gyro_bias_radps->std);
}

TEST(EstimateWheel, SaysHowManyReadingsOfASaturatedGyroscopeItLeavesOut) {
  const auto noted = [](double most_radps) {
    WheelSensor sensor = record(lively, {}, 60.0, 9);
    test::Normal normal(5);
    for (const double t : sensor.time_s) {
      sensor.rate_radps[0].push_back(0.01 * normal());
      sensor.rate_radps[1].push_back(0.01 * normal());
      sensor.rate_radps[2].push_back(
          std::min(lively.at(t).speed_radps + 0.01 * normal(), most_radps));
    }
    const auto solution =
        solve({sensor}, with(&WheelOptions::spin_axis, std::array{0.0, 0.0, 1.0}));
    expect_turns(solution, lively.turns(0.0, 9.0), 0.02);
    std::string texts = solution.sensors[0].has_gyro ? "" : "unused ";
    for (const Note& note : solution.notes)
      if (note.text.find("gyroscope") != std::string::npos) texts += note.text;
    return texts;
  };
  EXPECT_EQ(noted(100.0), "");
  EXPECT_THAT(noted(6.0), testing::MatchesRegex(
                              "sensor: [1-9][0-9]+ readings of the gyroscope are at the end of its "
                              "range, and are not used"));
  EXPECT_EQ(noted(-1.0),
            "unused sensor: the gyroscope reads the same value throughout, and is not used");
}

// Two seconds without an accelerometer, in which a turn may hide without the gyroscope.
TEST(EstimateWheel, AGyroscopeCountsThroughWhatTheAccelerometersMiss) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  test::Normal normal(5);
  for (const double t : sensor.time_s) {
    sensor.rate_radps[0].push_back(0.0);
    sensor.rate_radps[1].push_back(0.0);
    sensor.rate_radps[2].push_back(lively.at(t).speed_radps + 0.01 * normal());
  }
  for (std::size_t row = 180; row < 300; ++row)
    for (auto& axis : sensor.accel_mps2) axis[row] += 10.0 * normal();
  const auto solution = solve({sensor}, with(&WheelOptions::spin_axis, std::array{0.0, 0.0, 1.0}));
  expect_turns(solution, lively.turns(0.0, 9.0), 0.02);
}

TEST(EstimateWheel, AGivenAxisTheOtherWayRoundTurnsTheSign) {
  const auto solution = solve({record(lively, {}, 60.0, 8)},
                              with(&WheelOptions::spin_axis, std::array{0.0, 0.0, -2.0}));
  expect_turns(solution, -lively.turns(0.0, 9.0), 0.004);
  EXPECT_TRUE(solution.sensors[0].spin_axis_given);
}

TEST(EstimateWheel, BridgesAGapInWhichThePhaseCannotSlip) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  const auto hole = [](std::vector<double>& column) {
    if (!column.empty())
      column.erase(column.begin() + 240, column.begin() + 258);  // 0.3 s at 90 rpm
  };
  hole(sensor.time_s);
  for (auto& axis : sensor.accel_mps2) hole(axis);
  expect_turns(solve({sensor}), lively.turns(0.0, 9.0), 0.004);
}

TEST(EstimateWheel, AGapInWhichATurnMayHideHasNoTurns) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  const auto hole = [](std::vector<double>& column) {
    if (!column.empty()) column.erase(column.begin() + 120, column.begin() + 360);  // 4 s
  };
  hole(sensor.time_s);
  for (auto& axis : sensor.accel_mps2) hole(axis);
  const auto solution = estimate_wheel({sensor}, {});
  if (!solution.has_value()) return;  // an error that says so would do as well
  EXPECT_FALSE(solution->turns.has_value());
  EXPECT_TRUE(std::ranges::any_of(solution->notes, [](const Note& note) {
    return note.severity == Severity::bad && note.text.starts_with("turns: ");
  }));
}

TEST(EstimateWheel, NothingOfACorruptRowReachesAnAnswer) {
  const WheelSensor clean = record(lively, {}, 60.0, 10);
  WheelSensor dirty = clean;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const std::array values{nan, infinite, 3e34, 1e-40, 0.0};
  for (std::size_t i = 0; i < 10; ++i) test::spoil(dirty, 30 + 50 * i, values[i % values.size()]);
  const auto expected = solve({clean}), solution = solve({dirty});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.004);
  ASSERT_TRUE(solution.turns && expected.turns);
  EXPECT_NEAR(solution.turns->value, expected.turns->value, 1e-3);
  EXPECT_EQ(solution.sensors[0].unusable, 10U);
  EXPECT_EQ(solution.rejected_samples, expected.rejected_samples + 10);
  std::size_t named = 0;
  for (const Stretch& stretch : solution.rejected) {
    EXPECT_TRUE(std::isfinite(stretch.start_s) && std::isfinite(stretch.end_s));
    if (stretch.reason.starts_with("sensor: ")) named += stretch.rows;
  }
  EXPECT_EQ(named, 10U);
}

// Knocks no screen can know for such: beyond the gate, so the filter leaves them out and counts
// them.
TEST(EstimateWheel, KnocksAreGatedAndCounted) {
  const WheelSensor clean = record(lively, {}, 60.0, 10);
  WheelSensor knocked = clean;
  for (std::size_t i = 0; i < 5; ++i) knocked.accel_mps2[0][40 + 90 * i] += 60.0;
  const auto solution = solve({knocked});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.005);
  EXPECT_GE(solution.rejected_samples, solve({clean}).rejected_samples + 5);
}

TEST(EstimateWheel, AtRestTurnsNothingAndSaysThatTheAxleIsAssumed) {
  const Drive rest{{0.3, 0.0}, {{6.0, 0.0}}};
  const auto solution = solve({record(rest, {}, 60.0, 11)});
  ASSERT_TRUE(solution.turns.has_value());
  EXPECT_LT(std::abs(solution.turns->value), std::max(3.0 * solution.turns->std, 1e-3));
  EXPECT_LT(solution.turns->std, 0.01);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const Note& note) {
    return note.text.find("hardly turned") != std::string::npos;
  }));
  EXPECT_FALSE(solution.not_observable.empty());
}

TEST(EstimateWheel, OfAnUprightAxleIsNotObservable) {
  const auto upright =
      estimate_wheel({record(lively, {}, 60.0, 12, {.axle_tilt_rad = test::pi / 2})},
                     with(&WheelOptions::spin_axis, std::array{0.0, 0.0, 1.0}));
  ASSERT_FALSE(upright.has_value());
  EXPECT_EQ(upright.error().code, Errc::not_observable);
  EXPECT_NE(upright.error().message.find("axle upright"), std::string::npos);
}

TEST(EstimateWheel, OfAnUprightAxleIsNotObservableEvenWhereTheAxisIsLookedFor) {
  const auto upright =
      estimate_wheel({record(lively, {}, 60.0, 12, {.axle_tilt_rad = test::pi / 2})}, {});
  ASSERT_FALSE(upright.has_value());
  EXPECT_EQ(upright.error().code, Errc::not_observable);
}

TEST(EstimateWheel, OnATiltedAxleTakesTheGravityThatIsLeft) {
  const auto solution = solve({record(lively, {}, 60.0, 12, {.axle_tilt_rad = 0.4})});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.004);
  ASSERT_TRUE(solution.sensors[0].scale[0].has_value());
  EXPECT_NEAR(solution.sensors[0].scale[0]->value, 1.0, 0.02);
}

TEST(EstimateWheel, SaysWhatIsWrongWithWhatItWasGiven) {
  const auto message = [](const std::vector<WheelSensor>& sensors,
                          const WheelOptions& options = {}) {
    const auto solution = estimate_wheel(sensors, options);
    return solution.has_value() ? std::string("no error") : solution.error().message;
  };
  WheelSensor sensor = record({{}, {{1.0, 0.0}}}, {}, 60.0, 1);
  EXPECT_EQ(message({}), "a wheel takes one or two sensors, not 0");
  EXPECT_EQ(
      message({sensor}, with(&WheelOptions::gravity_mps2, -1.0)),
      "gravity, radii and bandwidth must be positive (the sensor's radius may be 0), standard "
      "deviations not negative");
  EXPECT_EQ(
      message({sensor}, with(&WheelOptions::rim_radius_m, 0.0)),
      "gravity, radii and bandwidth must be positive (the sensor's radius may be 0), standard "
      "deviations not negative");
  WheelSensor ragged = sensor;
  ragged.accel_mps2[1].pop_back();
  WheelSensor short_gyro = sensor;
  short_gyro.rate_radps[0] = {1.0};
  EXPECT_EQ(message({short_gyro}), "sensor: the gyroscope's channels are of other lengths");
  EXPECT_EQ(message({ragged}), "sensor: channels of different lengths");
  for (auto& axis : sensor.accel_mps2)
    std::ranges::fill(axis, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(message({sensor}), "sensor: only 0 usable rows; a wheel needs at least 10");
}

}  // namespace
}  // namespace proofmass::estimate::wheel_test
