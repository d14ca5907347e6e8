#include "proofmass/estimate/position_budget.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/core/units.hpp"
#include "proofmass/sensor/grades.hpp"

namespace proofmass::estimate::position_budget_test {
namespace {

double rounded(double value, int digits) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) + 1 - digits);
  return std::round(value / unit) * unit;
}

struct Cell {
  double value_m;
  int digits;
};

// Table 2.1 of the thesis, but for three of its cells: "015 mm" is 15 mm, and see below.
constexpr std::array<std::array<Cell, 4>, 4> table{{
    {{{0.12e-3, 2}, {12e-3, 2}, {0.44, 2}, {1.6e3, 2}}},
    {{{1.5e-3, 2}, {150e-3, 2}, {5.3, 2}, {19e3, 2}}},
    {{{15e-3, 2}, {1.5, 2}, {53.0, 2}, {190e3, 2}}},
    {{{610e-3, 2}, {60.0, 1}, {2.2e3, 2}, {7900e3, 2}}},
}};

TEST(PositionBudget, OfTheGradesIsTheThesissTable) {
  const auto rows = position_budget(grade_sensors(), sensor::grade_times_s);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[2].name, "Industrial");
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(rows[i].errors.size(), 4U);
    for (std::size_t j = 0; j < 4; ++j) {
      const auto [value_m, digits] = table[i][j];
      const BudgetError& error = rows[i].errors[j];
      EXPECT_NEAR(rounded(error.position_m.value, digits), value_m, 1e-9 * value_m)
          << rows[i].name << " at " << error.t_s << " s";
      EXPECT_EQ(error.position_m.std, 0.0);
    }
  }
}

// The thesis prints 0.13 mm and 620 mm there: half a digit from ½ b t² with 10 m/s² to the g.
TEST(PositionBudget, TwoCellsOfTheThesisTakeTenMetresPerSecondSquaredForG) {
  const auto rows = position_budget(grade_sensors(), std::array{1.0});
  const double ten = 10.0 / standard_gravity_mps2;
  EXPECT_NEAR(rows[0].errors[0].position_m.value * ten, 0.13e-3, 0.00501e-3);
  EXPECT_NEAR(rows[3].errors[0].position_m.value * ten, 620e-3, 5.01e-3);
}

TEST(PositionBudget, CarriesTheBiasesUncertainty) {
  const std::vector<BudgetSensor> sensors{{.name = "s", .bias_mps2 = {-0.02, 0.005}}};
  const auto rows = position_budget(sensors, std::array{0.0, 4.0});
  EXPECT_EQ(rows[0].errors[0].position_m.value, 0.0);
  EXPECT_EQ(rows[0].errors[0].position_m.std, 0.0);
  EXPECT_DOUBLE_EQ(rows[0].errors[1].position_m.value, -0.16);
  EXPECT_DOUBLE_EQ(rows[0].errors[1].position_m.std, 0.04);
}

// Second computation: white noise of density N, sampled, is integrated twice many times over.
TEST(PositionBudget, NoiseSpreadsThePositionAsItsIntegralDoes) {
  constexpr double N = 1e-3, dt = 0.05;
  constexpr int steps = 200, runs = 4000;
  std::mt19937_64 engine(1);
  double squares = 0.0;
  for (int run = 0; run < runs; ++run) {
    double position = 0.0, velocity = 0.0;
    for (int k = 0; k < steps; ++k) {
      double sum = 0.0;  // of 12 evens: mean 0, variance 1
      for (int i = 0; i < 12; ++i) sum += static_cast<double>(engine() >> 11U) * 0x1p-53;
      const double accel = N / std::sqrt(dt) * (sum - 6.0);
      position += velocity * dt + 0.5 * accel * dt * dt;
      velocity += accel * dt;
    }
    squares += position * position;
  }
  const std::vector<BudgetSensor> sensors{
      {.name = "s", .bias_mps2 = {0.0, 0.0}, .white_noise_mps2_rthz = N}};
  const double std_m = position_budget(sensors, std::array{steps * dt})[0].errors[0].position_m.std;
  EXPECT_DOUBLE_EQ(std_m, N * std::pow(10.0, 1.5) / std::sqrt(3.0));
  EXPECT_NEAR(std::sqrt(squares / runs), std_m, 5.0 * std_m / std::sqrt(2.0 * runs));
}

TEST(PositionBudget, AddsNoiseAndBiasInQuadrature) {
  const std::vector<BudgetSensor> sensors{
      {.name = "s", .bias_mps2 = {0.0, 0.03}, .white_noise_mps2_rthz = 0.04}};
  const double t = 4.0 / 3.0;  // there ½ t² and √(t³/3) are equal
  const double each = 0.5 * t * t;
  EXPECT_NEAR(position_budget(sensors, std::array{t})[0].errors[0].position_m.std, 0.05 * each,
              1e-14);
}

}  // namespace
}  // namespace proofmass::estimate::position_budget_test
