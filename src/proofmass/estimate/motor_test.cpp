#include "proofmass/estimate/motor.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "proofmass/estimate/motor/angle.hpp"
#include "proofmass/estimate/motor/level_regression.hpp"
#include "proofmass/estimate/motor/series.hpp"
#include "proofmass/estimate/motor_test_support.hpp"

namespace proofmass::estimate::motor_test {
namespace {

// Within four standard deviations, and determined to a few percent.
void expect_found(const MotorSolution& solution, const char* name, double truth, double relative) {
  const MotorParameter* found = solution.find(name);
  ASSERT_NE(found, nullptr) << name;
  ASSERT_TRUE(found->value) << name << ": " << found->reason;
  EXPECT_NEAR(found->value->value, truth, 4.0 * found->value->std) << name;
  EXPECT_LT(found->value->std, relative * truth) << name;
}

void expect_absent(const MotorSolution& solution, const char* name) {
  const MotorParameter* found = solution.find(name);
  ASSERT_NE(found, nullptr) << name;
  EXPECT_FALSE(found->value) << name << " " << found->value->value;
  EXPECT_FALSE(found->reason.empty()) << name;
}

TEST(Motor, FindsTheDriveOfAnotherSimulator) {
  const TrueDrive drive;
  const MotorSolution found = estimate_motor(simulated(drive, {}, exploring, 1)).value();
  expect_found(found, "resistance", drive.resistance, 0.02);
  expect_found(found, "torque_constant", drive.torque_constant, 0.01);
  expect_found(found, "inertia", drive.inertia(), 0.1);
  expect_found(found, "coulomb_friction", drive.total_coulomb(), 0.1);
  expect_found(found, "backlash", drive.backlash, 0.1);
  EXPECT_GT(found.reversals, 10U);
}

// Below their drop brushes take the whole voltage of a motor at rest, which is no back-EMF:
// resistances were 14.7 to 15.0 ± 1.0 ohm.
TEST(Motor, TheVoltageThatBrushesTakeAtRestIsNoMotion) {
  const TrueDrive drive{.brush_drop = 0.7};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const MotorSolution found =
        estimate_motor(
            simulated(drive, {.ripple_v = 0.0, .encoder_counts = 4096.0}, with_rests, seed))
            .value();
    // How the drop rises with the current is not known.
    expect_found(found, "resistance", drive.resistance, 0.1);
    expect_found(found, "torque_constant", drive.torque_constant, 0.03);
    expect_found(found, "coulomb_friction", drive.total_coulomb(), 0.1);
  }
}

// The drop was taken to change its sign within a fiftieth of the largest current: resistances were
// up to 24 standard deviations off.
TEST(Motor, FindsHowTheBrushesDropRises) {
  for (const double knee : {0.003, 0.015, 0.04}) {
    const TrueDrive drive{.brush_drop = 0.7, .brush_knee = knee};
    const MotorSolution found =
        estimate_motor(simulated(drive, {.encoder_counts = 4096.0}, exploring, 1)).value();
    expect_found(found, "resistance", drive.resistance, 0.05);
    expect_found(found, "backlash", drive.backlash, 0.2);
    expect_found(found, "coulomb_friction", drive.total_coulomb(), 0.1);
  }
}

// The offset of a current's channel shows at rest.
TEST(Motor, AnOffsetOfTheCurrentDoesNotMatter) {
  const TrueDrive drive;
  const TrueMeasurement how{.encoder_counts = 4096.0};
  const MotorRecord record = simulated(drive, how, with_rests, 1);
  MotorRecord shifted = record;
  for (double& i : shifted.current_a) i += 0.04;
  const MotorSolution found = estimate_motor(record).value(),
                      with_offset = estimate_motor(shifted).value();
  for (const MotorParameter& one : found.parameters) {
    if (!one.value) continue;
    const MotorParameter* same = with_offset.find(one.name);
    ASSERT_TRUE(same->value) << one.name;
    EXPECT_NEAR(same->value->value, one.value->value, 0.3 * one.value->std) << one.name;
  }
  ASSERT_EQ(with_offset.notes.size(), found.notes.size() + 1);
  EXPECT_EQ(with_offset.notes.back().text,
            "current: 0.040 A at rest without a voltage are subtracted");
}

// Noise of the current attenuates what multiplies it: resistance and inertia were up to four
// standard deviations off.
TEST(Motor, NoiseOfTheCurrentIsAccountedFor) {
  const TrueDrive drive;
  double least_z = 0.0, most_z = 0.0;
  for (const std::uint64_t seed : {1U, 2U}) {
    const MotorSolution found =
        estimate_motor(
            simulated(drive, {.current_noise = 0.02, .encoder_counts = 4096.0}, exploring, seed))
            .value();
    for (const auto& [name, truth] :
         {std::pair{"resistance", drive.resistance}, std::pair{"inertia", drive.inertia()}}) {
      const MotorParameter* one = found.find(name);
      if (!one->value) continue;
      const double z = (one->value->value - truth) / one->value->std;
      least_z = std::min(least_z, z);
      most_z = std::max(most_z, z);
    }
  }
  EXPECT_GT(least_z, -3.0);
  EXPECT_LT(most_z, 3.0);
}

TEST(Motor, SingleOutliersAreLeftOut) {
  const TrueDrive drive;
  MotorRecord record = simulated(drive, {.encoder_counts = 4096.0}, exploring, 2);
  for (std::size_t k = 100; k < record.time_s.size(); k += 300) {
    record.voltage_v[k] += 15.0;
    record.current_a[k + 20] -= 2.0;
    record.angle_rad[k + 40] += 0.5;
  }
  const MotorSolution found = estimate_motor(record).value();
  expect_found(found, "resistance", drive.resistance, 0.03);
  expect_found(found, "torque_constant", drive.torque_constant, 0.01);
  expect_found(found, "coulomb_friction", drive.total_coulomb(), 0.1);
  expect_found(found, "backlash", drive.backlash, 0.1);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].text.find("27 of the voltage, 27 of the current, 27 of the angle"),
            std::string::npos)
      << found.notes[0].text;
}

TEST(Motor, ACoarseCurrentIsNotUsed) {
  MotorRecord record =
      simulated({}, {.current_step = 0.08, .encoder_counts = 4096.0}, exploring, 2);
  const MotorSolution found = estimate_motor(record).value();
  EXPECT_FALSE(found.has_current);
  expect_absent(found, "resistance");
  ASSERT_FALSE(found.notes.empty());
  EXPECT_NE(found.notes[0].text.find("too coarse"), std::string::npos) << found.notes[0].text;
}

// A voltage in steps, at which the load overruns the motor: while it brakes the flank is not known.
// Torque constants were up to 34 standard deviations off.
TEST(Motor, ALoadThatOverrunsTheMotorDoesNotCount) {
  const TrueDrive drive{
      .motor_inertia = 0.3, .load_inertia = 0.3, .coulomb = 1.0, .load_coulomb = 2.0};
  const Voltage steps = [](double t) {
    constexpr std::array levels{20.0, 0.0, -20.0, 10.0, 20.0, -10.0, 0.0, -20.0};
    return levels[static_cast<std::size_t>(t / 0.8) % levels.size()];
  };
  for (const std::uint64_t seed : {1U, 2U}) {
    const MotorSolution found =
        estimate_motor(simulated(drive, {.encoder_counts = 4096.0}, steps, seed)).value();
    expect_found(found, "torque_constant", drive.torque_constant, 0.05);
    expect_found(found, "backlash", drive.backlash, 0.3);
  }
}

// Up to a quarter of the top speed only, the Coulomb friction took the remainder of the fall.
TEST(Motor, FindsAStribeckSpeedOfAThirdOfTheTopSpeed) {
  const TrueDrive drive{.stribeck_speed = 0.25};
  const Voltage slowly = [](double t) {
    return 15.0 * std::sin(1.1 * t) + 5.0 * std::sin(0.37 * t);
  };
  const MotorSolution found =
      estimate_motor(simulated(drive, {.encoder_counts = 4096.0}, slowly, 1)).value();
  expect_found(found, "stribeck_speed", drive.stribeck_speed, 0.2);
  expect_found(found, "coulomb_friction", drive.total_coulomb(), 0.1);
}

TEST(Motor, WithoutACurrentFindsTheRatios) {
  const TrueDrive drive;
  MotorRecord record = simulated(drive, {}, exploring, 2);
  record.current_a.clear();
  const MotorSolution found = estimate_motor(record).value();
  const double R = drive.resistance, K = drive.torque_constant, B = K + drive.viscous * R / K;
  expect_found(found, "gain", 1.0 / B, 0.02);
  expect_found(found, "friction_voltage", drive.total_coulomb() * R / K, 0.1);
  expect_absent(found, "backlash");
  expect_absent(found, "inertia");
  expect_absent(found, "torque_constant");
  expect_absent(found, "coulomb_friction");
}

// The voltage was integrated over the gap, in which it was not recorded: the torque constant was up
// to five standard deviations off.
TEST(Motor, IntegratesOverNoGap) {
  const TrueDrive drive;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    MotorRecord record = simulated(drive, {}, exploring, seed);
    // The clock is set forward.
    for (double& t : record.time_s)
      if (t > 17.0) t += 12.0;
    const MotorSolution found = estimate_motor(record).value();
    expect_found(found, "resistance", drive.resistance, 0.03);
    expect_found(found, "torque_constant", drive.torque_constant, 0.01);
    expect_found(found, "inertia", drive.inertia(), 0.1);
    expect_found(found, "coulomb_friction", drive.total_coulomb(), 0.1);
    expect_found(found, "backlash", drive.backlash, 0.1);
  }
}

TEST(Motor, WithoutAReversalTheBacklashIsNotDetermined) {
  const Voltage forwards = [](double t) { return 22.0 + 8.0 * std::sin(1.7 * t); };
  const MotorSolution found =
      estimate_motor(simulated({}, {.duration_s = 20.0}, forwards, 3)).value();
  expect_absent(found, "backlash");
}

TEST(Motor, AtOneSpeedFrictionTermsAreNotSeparated) {
  const Voltage constant = [](double) { return 25.0; };
  MotorRecord record = simulated({}, {.duration_s = 24.0}, constant, 4);
  // From after the start on.
  const auto drop = [](std::vector<double>& values) {
    values.erase(values.begin(), values.begin() + 400);
  };
  drop(record.time_s);
  drop(record.voltage_v);
  drop(record.current_a);
  for (auto& sensor : record.accel_mps2)
    for (auto& axis : sensor) drop(axis);
  const MotorSolution found = estimate_motor(record).value();
  expect_absent(found, "viscous_friction");
  expect_absent(found, "coulomb_friction");
  expect_absent(found, "breakaway_friction");
}

TEST(Motor, RefusesALoadThatRests) {
  const Voltage nothing = [](double) { return 0.0; };
  EXPECT_FALSE(estimate_motor(simulated({}, {.duration_s = 5.0}, nothing, 5)));
}

// Pushes to and fro that hardly leave a rest: an error, not a violated contract.
TEST(Motor, RefusesALoadThatHardlyMoves) {
  MotorRecord record;
  for (int k = 0; k < 800; ++k) {
    const double t = 0.005 * k;
    record.time_s.push_back(t);
    record.voltage_v.push_back(3.0 * std::sin(40.0 * t));
    record.angle_rad.push_back(0.02 * std::sin(40.0 * t));
  }
  const auto without = estimate_motor(record);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().code, Errc::not_observable);
  record.current_a.assign(record.time_s.size(), 0.1);
  EXPECT_FALSE(estimate_motor(record));
}

TEST(Motor, RefusesColumnsOfUnequalLength) {
  MotorRecord record = simulated({}, {.duration_s = 2.0}, exploring, 6);
  record.current_a.pop_back();
  const auto found = estimate_motor(record);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::invalid_argument);
}

TEST(Motor, AnEncoderTakesThePlaceOfTheAccelerometers) {
  const TrueDrive drive;
  const MotorSolution found =
      estimate_motor(simulated(drive, {.sensors = 0, .encoder_counts = 10'000}, exploring, 7))
          .value();
  expect_found(found, "torque_constant", drive.torque_constant, 0.005);
  expect_found(found, "backlash", drive.backlash, 0.05);
}

// A line with noise that is white plus a random walk: the regression finds slope, noise and ratio.
TEST(MotorLevelRegression, FindsSlopeAndNoise) {
  constexpr int n = 4000;
  constexpr double step_s = 0.01, white = 0.3, walk_psd = 0.04, slope = 2.0;
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal;
  motor::LevelRegression regression{.columns = Eigen::MatrixXd(2, n),
                                    .starts = {0},
                                    .prior_std = Eigen::VectorXd::Constant(1, 1e3),
                                    .prior_mean = Eigen::VectorXd::Zero(1)};
  double level = 5.0;
  for (int k = 0; k < n; ++k) {
    const double t = k * step_s, x = std::sin(0.7 * t);
    level += std::sqrt(walk_psd * step_s) * normal(engine);
    regression.columns.col(k) << x, slope * x + level + white * normal(engine);
    regression.time_s.push_back(t);
  }
  const motor::LevelFit found = motor::fit(regression);
  const double std = std::sqrt(found.covariance(0, 0));
  EXPECT_NEAR(found.value(0), slope, 3.0 * std);
  EXPECT_LT(std, 0.3);
  EXPECT_NEAR(found.white_std, white, 0.02);
  EXPECT_NEAR(std::log(found.ratio), std::log(walk_psd / (white * white)), 0.6);
  EXPECT_NEAR(found.correlation, 0.0, 0.05);
}

// The change with y is that of a fit to the changed y.
TEST(MotorLevelRegression, RespondsLinearly) {
  constexpr int n = 300;
  motor::LevelRegression regression{.columns = Eigen::MatrixXd(2, n),
                                    .starts = {0, 120},
                                    .prior_std = Eigen::VectorXd::Constant(1, 1e6),
                                    .prior_mean = Eigen::VectorXd::Zero(1)};
  Eigen::MatrixXd target(n, 1);
  for (int k = 0; k < n; ++k) {
    regression.columns.col(k) << std::cos(0.05 * k), std::sin(0.3 * k);
    regression.time_s.push_back(0.1 * k);
    target(k, 0) = std::cos(0.05 * k + 0.4);
  }
  const motor::LevelFit before = motor::fit_at(regression, 2.0);
  motor::LevelRegression changed = regression;
  changed.columns.row(1) += 0.25 * target.transpose();
  const motor::LevelFit after = motor::fit_at(changed, 2.0);
  EXPECT_NEAR(after.value(0) - before.value(0),
              0.25 * motor::response(regression, before, target)(0, 0), 1e-9);
}

TEST(MotorSeries, SlopesOfACubicAreExact) {
  std::vector<double> y;
  for (int k = 0; k < 40; ++k) y.push_back(0.5 * k * k * k - 3.0 * k * k + k);
  const std::vector<double> slope = motor::slopes(y, 1.0, 5);
  for (std::size_t k = 5; k + 5 < y.size(); ++k) {
    const auto x = static_cast<double>(k);
    EXPECT_NEAR(slope[k], 1.5 * x * x - 6.0 * x + 1.0, 1e-8 * (1.0 + x * x));
  }
}

TEST(MotorSeries, RunsAreShortenedAtBothEnds) {
  std::vector<std::int8_t> contact{0, 1, 1, 1, 1, 1, -1, -1, -1, 0};
  motor::shorten_runs(contact, 2);
  EXPECT_EQ(contact, (std::vector<std::int8_t>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0}));
}

TEST(MotorAngle, IsThatOfGravityWhateverTheBias) {
  motor::PlaneAxes axes;
  for (int k = 0; k < 1000; ++k) {
    const double angle = 0.02 * k;
    axes[0].push_back(9.8 * std::sin(angle) + 0.4);
    axes[1].push_back(9.8 * std::cos(angle) - 0.3);
  }
  const std::vector<double> found = motor::angle_of({axes}, 9.8).value();
  EXPECT_NEAR(found.back() - found.front(), 0.02 * 999, 2e-3);
}

TEST(MotorAngle, RefusesAnAxleThatIsVertical) {
  const motor::PlaneAxes axes{std::vector<double>(100, 0.1), std::vector<double>(100, 0.2)};
  EXPECT_FALSE(motor::angle_of({axes}, 9.8));
}

}  // namespace
}  // namespace proofmass::estimate::motor_test
