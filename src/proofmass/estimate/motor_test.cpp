#include "proofmass/estimate/motor.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/motor/angle.hpp"
#include "proofmass/estimate/motor/model.hpp"
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

TEST(Motor, WithoutACurrentFindsTheRatios) {
  const TrueDrive drive;
  MotorRecord record = simulated(drive, {}, exploring, 2);
  record.current_a.clear();
  const MotorSolution found = estimate_motor(record).value();
  const double R = drive.resistance, K = drive.torque_constant, B = K + drive.viscous * R / K;
  expect_found(found, "gain", 1.0 / B, 0.02);
  expect_found(found, "friction_voltage", drive.total_coulomb() * R / K, 0.1);
  expect_found(found, "backlash", drive.backlash, 0.1);
  expect_absent(found, "inertia");
  expect_absent(found, "torque_constant");
  expect_absent(found, "coulomb_friction");
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
  const auto drop = [](std::vector<double>& values) { values.erase(values.begin(), values.begin() + 400); };
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

TEST(Motor, RefusesColumnsOfUnequalLength) {
  MotorRecord record = simulated({}, {.duration_s = 2.0}, exploring, 6);
  record.current_a.pop_back();
  const auto found = estimate_motor(record);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::invalid_argument);
}

TEST(MotorModel, TwoStepsAreOneOfTwiceTheLength) {
  motor::Parameters p;
  p.value[motor::resistance] = std::log(13.0);
  p.value[motor::torque_constant] = std::log(22.6);
  p.value[motor::inductance] = std::log(0.05);
  p.value[motor::inertia] = std::log(0.6);
  p.value[motor::viscous] = 0.8;
  p.value[motor::torque_noise] = std::log(0.1);
  p.value[motor::voltage_noise] = std::log(0.01);
  const motor::Transition one = motor::moving(p, true, 0.005), two = motor::moving(p, true, 0.01);
  EXPECT_LT((one.F * one.F - two.F).norm(), 1e-9);
  EXPECT_LT((one.F * one.Q * one.F.transpose() + one.Q - two.Q).norm(), 1e-6 * two.Q.norm());
  EXPECT_LT((one.F * one.from_voltage + one.from_voltage - two.from_voltage).norm(), 1e-9);
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
