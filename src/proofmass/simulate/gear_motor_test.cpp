#include "proofmass/simulate/gear_motor.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/simulate/motor_rig.hpp"

namespace proofmass::simulate::gear_motor_test {
namespace {

GearMotorParameters smooth_motor() {
  GearMotorParameters p;
  p.backlash_rad = 0.0;
  return p;
}

TEST(GearMotor, TurnsAsTheBalanceOfTorqueRequires) {
  const GearMotorParameters p = smooth_motor();
  GearMotor drive(p);
  drive.advance(30.0, 2.0);
  const double w = drive.state().motor_radps, i = drive.state().current_a;
  EXPECT_NEAR(30.0, p.resistance_ohm * i + p.torque_constant_nmpa * w, 1e-6);
  EXPECT_NEAR(p.torque_constant_nmpa * i, p.coulomb_nm + p.load_coulomb_nm + p.viscous_nmspr * w,
              1e-4);
}

TEST(GearMotor, SpeedsUpWithTheMechanicalTimeConstant) {
  GearMotorParameters p = smooth_motor();
  p.inductance_h = 0.0;
  p.coulomb_nm = p.breakaway_nm = p.load_coulomb_nm = p.viscous_nmspr = 0.0;
  GearMotor drive(p);
  const double K = p.torque_constant_nmpa;
  const double tau = (p.motor_inertia_kgm2 + p.load_inertia_kgm2) * p.resistance_ohm / (K * K);
  drive.advance(10.0, tau);
  EXPECT_NEAR(drive.state().motor_radps, 10.0 / K * (1.0 - std::exp(-1.0)), 1e-3 * 10.0 / K);
}

TEST(GearMotor, StaysAtRestBelowBreakaway) {
  const GearMotorParameters p = smooth_motor();
  GearMotor drive(p);
  const double enough_v =
      (p.breakaway_nm + p.load_coulomb_nm) * p.resistance_ohm / p.torque_constant_nmpa;
  drive.advance(0.99 * enough_v, 1.0);
  EXPECT_EQ(drive.state().motor_rad, 0.0);
  drive.advance(1.02 * enough_v, 1.0);
  EXPECT_GT(drive.state().motor_rad, 0.0);
}

TEST(GearMotor, CrossesTheGapBeforeTheLoadReturns) {
  GearMotorParameters p;
  p.backlash_rad = 0.02;
  GearMotor drive(p);
  drive.advance(15.0, 1.0);
  EXPECT_EQ(drive.state().contact, 1);
  EXPECT_NEAR(drive.state().motor_rad - drive.state().load_rad, 0.01, 1e-12);
  drive.advance(0.0, 1.0);
  const double load_rad = drive.state().load_rad;
  while (drive.state().contact >= 0) {
    drive.advance(-8.0, 1e-4);
    ASSERT_NEAR(drive.state().load_rad, load_rad, 0.02);
  }
  EXPECT_NEAR(drive.state().motor_rad - drive.state().load_rad, -0.01, 1e-12);
}

TEST(GearMotor, TheLoadNeverLeavesTheGap) {
  GearMotorParameters p;
  p.unbalance_nm = 1.0;
  GearMotor drive(p);
  for (int k = 0; k < 4000; ++k) {
    drive.advance(exploring_voltage(k * 0.005), 0.005);
    const double apart = drive.state().motor_rad - drive.state().load_rad;
    ASSERT_LE(std::abs(apart), 0.5 * p.backlash_rad + 1e-3);
  }
}

TEST(MotorRig, RecordsTheSameNumbersForTheSameSeed) {
  MotorOptions options;
  options.duration_s = 2.0;
  const MotorResult a = simulate_motor(options).value(), b = simulate_motor(options).value();
  EXPECT_EQ(a.recording.channels[2].values, b.recording.channels[2].values);
  options.seed = 2;
  EXPECT_NE(simulate_motor(options).value().recording.channels[2].values,
            a.recording.channels[2].values);
}

TEST(MotorRig, RefusesAMotorThatCannotBe) {
  MotorOptions options;
  options.drive.breakaway_nm = 0.5 * options.drive.coulomb_nm;
  EXPECT_FALSE(simulate_motor(options));
  options = {};
  options.drive.load_inertia_kgm2 = 0.0;
  EXPECT_FALSE(simulate_motor(options));
  options = {};
  options.adc_bits = 99;
  EXPECT_FALSE(simulate_motor(options));
  options = {};
  options.rate_hz = 1e9;
  EXPECT_FALSE(simulate_motor(options));
}

}  // namespace
}  // namespace proofmass::simulate::gear_motor_test
