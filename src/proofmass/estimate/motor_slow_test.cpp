#include <cstdint>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <string>

#include "proofmass/estimate/motor_test_support.hpp"

// Coverage of the 95 % intervals over drives drawn at random.
namespace proofmass::estimate::motor_slow_test {
namespace {

using motor_test::TrueDrive;

TrueDrive drawn(std::uint64_t seed) {
  std::mt19937_64 engine(1000 + seed);
  std::uniform_real_distribution<double> share;
  TrueDrive drive;
  drive.backlash = 0.004 + 0.012 * share(engine);
  drive.coulomb = 2.0 + 2.0 * share(engine);
  drive.stribeck = 0.5 + share(engine);
  drive.stribeck_speed = 0.05 + 0.06 * share(engine);
  drive.motor_inertia = 0.4 + 0.4 * share(engine);
  drive.viscous = 0.3 + 1.2 * share(engine);
  drive.resistance = 12.0 + 2.0 * share(engine);
  return drive;
}

std::map<std::string, double> truth_of(const TrueDrive& d) {
  const double R = d.resistance, K = d.torque_constant, B = K + d.viscous * R / K;
  return {{"resistance", R},
          {"torque_constant", K},
          {"inertia", d.inertia()},
          {"viscous_friction", d.viscous},
          {"coulomb_friction", d.total_coulomb()},
          {"breakaway_friction", d.total_coulomb() + d.stribeck},
          {"stribeck_speed", d.stribeck_speed},
          {"backlash", d.backlash},
          {"gain", 1.0 / B},
          {"time_constant", d.inertia() * R / (K * B)},
          {"friction_voltage", d.total_coulomb() * R / K},
          {"breakaway_voltage", (d.total_coulomb() + d.stribeck) * R / K}};
}

struct Count {
  int given = 0, inside = 0;
};

std::map<std::string, Count> coverage(int runs, bool with_current) {
  std::map<std::string, Count> counts;
  for (int run = 1; run <= runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    const TrueDrive drive = drawn(seed);
    MotorRecord record = motor_test::simulated(drive, {}, motor_test::exploring, seed);
    if (!with_current) record.current_a.clear();
    const MotorSolution found = estimate_motor(record).value();
    const auto truth = truth_of(drive);
    for (const MotorParameter& one : found.parameters) {
      if (!one.value || !truth.contains(one.name)) continue;
      const auto& [low, high] = *one.interval_95;
      const double t = truth.at(one.name);
      counts[one.name].given += 1;
      counts[one.name].inside += low <= t && t <= high ? 1 : 0;
    }
  }
  return counts;
}

// 95 % of 120 within the scatter of the count itself.
void expect_true_intervals(const std::map<std::string, Count>& counts, int runs) {
  for (const auto& [name, count] : counts) {
    EXPECT_GT(count.given, runs / 2) << name;
    EXPECT_GE(count.inside, 0.91 * count.given) << name << " " << count.inside << " of " << count.given;
    RecordProperty(name, std::to_string(count.inside) + " of " + std::to_string(count.given));
  }
}

TEST(MotorSlow, IntervalsHoldTheTruthWithACurrent) {
  constexpr int runs = 120;
  expect_true_intervals(coverage(runs, true), runs);
}

TEST(MotorSlow, IntervalsHoldTheTruthWithoutACurrent) {
  constexpr int runs = 120;
  expect_true_intervals(coverage(runs, false), runs);
}

}  // namespace
}  // namespace proofmass::estimate::motor_slow_test
