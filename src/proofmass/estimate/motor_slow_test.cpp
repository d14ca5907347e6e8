#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
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
  double largest = 0.0;  // error, in standard deviations
};

enum class Recorded { current, no_current, encoder, noisy_current };

struct Drawn {
  TrueDrive drive;
  MotorRecord record;
};

Drawn recorded_drive(std::uint64_t seed, Recorded recorded) {
  TrueDrive drive = drawn(seed);
  motor_test::TrueMeasurement how;
  if (recorded == Recorded::encoder || recorded == Recorded::noisy_current) {
    how.sensors = 0;
    how.encoder_counts = 4096.0;
  }
  if (recorded == Recorded::noisy_current) {
    std::mt19937_64 engine(2000 + seed);
    std::uniform_real_distribution<double> share;
    drive.brush_drop = share(engine);
    drive.brush_knee = std::exp(std::log(0.003) + std::log(10.0) * share(engine));
    how.current_noise = 0.01;
    how.current_offset = 0.06 * share(engine) - 0.03;
  }
  const motor_test::Voltage voltage =
      recorded == Recorded::noisy_current ? motor_test::with_rests : motor_test::exploring;
  Drawn out{drive, motor_test::simulated(drive, how, voltage, seed)};
  if (recorded == Recorded::no_current) out.record.current_a.clear();
  return out;
}

std::map<std::string, Count> coverage(int runs, Recorded recorded) {
  std::map<std::string, Count> counts;
  for (int run = 1; run <= runs; ++run) {
    const auto [drive, record] = recorded_drive(static_cast<std::uint64_t>(run), recorded);
    const MotorSolution found = estimate_motor(record).value();
    const auto truth = truth_of(drive);
    for (const MotorParameter& one : found.parameters) {
      if (!one.value || !truth.contains(one.name)) continue;
      const auto& [low, high] = *one.interval_95;
      const double t = truth.at(one.name);
      Count& count = counts[one.name];
      count.given += 1;
      count.inside += low <= t && t <= high ? 1 : 0;
      count.largest = std::max(count.largest, std::abs(one.value->value - t) / one.value->std);
    }
  }
  return counts;
}

// The table of docs/methods/motor.md. 95 % of 120 within the scatter of the count itself.
void expect_true_intervals(const char* scenario, Recorded recorded) {
  constexpr int runs = 120;
  for (const auto& [name, count] : coverage(runs, recorded)) {
    std::printf("| %s | %s | %d | %.0f %%, %.1f |\n", scenario, name.c_str(), count.given,
                100.0 * count.inside / count.given, count.largest);
    EXPECT_GT(count.given, runs / 2) << name;
    EXPECT_GE(count.inside, 0.90 * count.given)
        << name << " " << count.inside << " of " << count.given;
    EXPECT_LT(count.largest, 5.0) << name;
  }
}

TEST(MotorSlow, IntervalsHoldTheTruthWithACurrent) {
  expect_true_intervals("with current", Recorded::current);
}

TEST(MotorSlow, IntervalsHoldTheTruthWithoutACurrent) {
  expect_true_intervals("without current", Recorded::no_current);
}

// Brushes whose drop rises over 3 to 30 mA, noise of 10 mA, and an offset of the current.
TEST(MotorSlow, IntervalsHoldTheTruthWithANoisyCurrent) {
  expect_true_intervals("noisy current", Recorded::noisy_current);
}

TEST(MotorSlow, IntervalsHoldTheTruthWithAnEncoder) {
  expect_true_intervals("encoder", Recorded::encoder);
}

}  // namespace
}  // namespace proofmass::estimate::motor_slow_test
