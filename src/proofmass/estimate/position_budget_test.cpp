#include "proofmass/estimate/position_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <vector>

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

// Table 2.1 of the thesis, except for three of its cells: "015 mm" is 15 mm, and see below.
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

// The thesis prints 0.13 mm and 620 mm there: half a digit from ½ b t² with 10 m/s² per g.
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

// Independent computation: sampled white noise of density N is integrated twice, many times over.
TEST(PositionBudget, NoiseSpreadsThePositionAsItsIntegralDoes) {
  constexpr double N = 1e-3, dt = 0.05;
  constexpr int steps = 200, runs = 4000;
  std::mt19937_64 engine(1);
  double squares = 0.0;
  for (int run = 0; run < runs; ++run) {
    double position = 0.0, velocity = 0.0;
    for (int k = 0; k < steps; ++k) {
      double sum = 0.0;  // sum of 12 uniform deviates: mean 0, variance 1
      for (int i = 0; i < 12; ++i) sum += static_cast<double>(engine() >> 11U) * 0x1p-53;
      const double accel = N / std::sqrt(dt) * (sum - 6.0);
      position += velocity * dt + 0.5 * accel * dt * dt;
      velocity += accel * dt;
    }
    squares += position * position;
  }
  const std::vector<BudgetSensor> sensors{
      {.name = "s", .bias_mps2 = {0.0, 0.0}, .noise = {.white_mps2_rthz = N}}};
  const double std_m = position_budget(sensors, std::array{steps * dt})[0].errors[0].position_m.std;
  EXPECT_DOUBLE_EQ(std_m, N * std::pow(10.0, 1.5) / std::sqrt(3.0));
  EXPECT_NEAR(std::sqrt(squares / runs), std_m, 5.0 * std_m / std::sqrt(2.0 * runs));
}

TEST(PositionBudget, AddsNoiseAndBiasInQuadrature) {
  const std::vector<BudgetSensor> sensors{
      {.name = "s", .bias_mps2 = {0.0, 0.03}, .noise = {.white_mps2_rthz = 0.04}}};
  const double t = 4.0 / 3.0;  // ½ t² and √(t³/3) are equal there
  const double each = 0.5 * t * t;
  EXPECT_NEAR(position_budget(sensors, std::array{t})[0].errors[0].position_m.std, 0.05 * each,
              1e-14);
}

// --- flicker, random walk and ramp ---------------------------------------------------------------

/// A sum of cosines: amplitude, angular frequency and phase of each.
struct Cosine {
  double amplitude, omega, phase;
};

/// Flicker noise of one-sided density B²/(π f) as cosines with random phases and normal amplitudes,
/// one for each of many narrow bands on a logarithmic scale, up to a period of longest_s.
std::vector<Cosine> flicker_of(double B, double longest_s, std::mt19937_64& random) {
  constexpr double width = 0.02, decades = 7.0;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
  std::vector<Cosine> cosines;
  for (double octave = 0.0; octave < decades * std::numbers::ln10; octave += width) {
    const double f = std::exp(octave + 0.5 * width) / longest_s;
    // For a normal amplitude: the variance of a cosine is half its square.
    const double variance = B * B / std::numbers::pi * width;
    cosines.push_back(
        {std::sqrt(2.0 * variance) * normal(random), 2.0 * std::numbers::pi * f, turn(random)});
  }
  return cosines;
}

/// ∫∫ over [0, t] of one cosine, in closed form.
double twice_integrated(const Cosine& c, double t) {
  const double end = c.omega * t + c.phase;
  return c.amplitude * ((std::cos(c.phase) - std::cos(end)) / c.omega - t * std::sin(c.phase)) /
         c.omega;
}

double budget_std_m(const BudgetNoise& noise, double t_s) {
  const std::vector<BudgetSensor> sensors{{.name = "s", .bias_mps2 = {}, .noise = noise}};
  return position_budget(sensors, std::array{t_s})[0].errors[0].position_m.std;
}

TEST(PositionBudget, FlickerCountsByPeriodsUpToAnHourOrTenTimesTheIntegration) {
  constexpr double B = 2e-3, hour_s = 3600.0;
  constexpr int runs = 1500;
  std::mt19937_64 random(5);
  for (const double t_s : {1.0, 10.0, 60.0, 600.0}) {
    double squares = 0.0;
    for (int run = 0; run < runs; ++run) {
      double position = 0.0;
      for (const Cosine& c : flicker_of(B, std::max(hour_s, 10.0 * t_s), random))
        position += twice_integrated(c, t_s);
      squares += position * position;
    }
    EXPECT_NEAR(std::sqrt(squares / runs) / budget_std_m({.flicker_mps2 = B}, t_s), 1.0, 0.07)
        << t_s;
  }
}

TEST(PositionBudget, ARandomWalkCountsAsItsIncrementsIntegratedTwice) {
  constexpr double K = 3e-4, dt = 0.5;
  constexpr int steps = 1200, runs = 2000;
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  double squares = 0.0;
  for (int run = 0; run < runs; ++run) {
    double bias = 0.0, velocity = 0.0, position = 0.0;
    for (int k = 0; k < steps; ++k) {
      position += velocity * dt + 0.5 * bias * dt * dt;
      velocity += bias * dt;
      bias += K * std::sqrt(dt) * normal(random);
    }
    squares += position * position;
  }
  const double std_m = budget_std_m({.random_walk_mps2_rts = K}, steps * dt);
  EXPECT_NEAR(std_m, K * std::pow(600.0, 2.5) / std::sqrt(20.0), 1e-9 * std_m);
  EXPECT_NEAR(std::sqrt(squares / runs) / std_m, 1.0, 0.07);
}

// An ADIS16405's own noise, N 450 µg/√Hz, B 267 µg, K 45 µg/√s, with a bias known to 0.1 mg: the
// contributions other than bias and white noise grow to several times theirs.
TEST(PositionBudget, OfATypicalSensorMostComesFromFlickerAndRandomWalk) {
  constexpr double ug = 1e-6 * standard_gravity_mps2;
  const BudgetNoise noise{.white_mps2_rthz = 450.0 * ug,
                          .flicker_mps2 = 267.0 * ug,
                          .random_walk_mps2_rts = 45.0 * ug,
                          .ramp_mps3 = 0.0};
  const std::vector<BudgetSensor> whole{
      {.name = "s", .bias_mps2 = {0.0, 100.0 * ug}, .noise = noise}};
  const std::vector<BudgetSensor> plain{
      {.name = "s", .bias_mps2 = {0.0, 100.0 * ug}, .noise = {.white_mps2_rthz = 450.0 * ug}}};
  const std::array times_s{1.0, 10.0, 60.0, 600.0};
  const auto with = position_budget(whole, times_s), without = position_budget(plain, times_s);
  const std::array least{1.1, 1.7, 2.5, 5.0};
  for (std::size_t k = 0; k < times_s.size(); ++k)
    EXPECT_GT(with[0].errors[k].position_m.std / without[0].errors[k].position_m.std, least[k]);
}

TEST(PositionBudget, TheStdIsTheRootSumOfSquaresOfItsParts) {
  const std::vector<BudgetSensor> sensors{
      {.name = "s", .bias_mps2 = {0.1, 0.02}, .noise = {1e-2, 2e-2, 3e-2, 4e-2}}};
  const BudgetError error = position_budget(sensors, std::array{3.0})[0].errors[0];
  const BudgetParts& parts = error.parts;
  double squares = 0.0;
  for (const double part :
       {parts.bias_m, parts.white_m, parts.flicker_m, parts.random_walk_m, parts.ramp_m}) {
    EXPECT_GT(part, 0.0);
    squares += part * part;
  }
  EXPECT_DOUBLE_EQ(error.position_m.std, std::sqrt(squares));
  EXPECT_DOUBLE_EQ(parts.ramp_m, 4e-2 * 27.0 / 6.0);
}

// The sum that the closed forms replace: noise series, integrated twice, less the bias that the
// final velocity shows.
TEST(PositionBudget, BetweenRestsIsThatOfSimulatedIntegrations) {
  constexpr std::size_t steps = 400;
  constexpr double t_s = 10.0, dt = t_s / steps;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  double white2 = 0.0, walk2 = 0.0;
  constexpr int runs = 4000;
  for (int run = 0; run < runs; ++run) {
    double bias = 0.0;
    std::array<double, 2> v{}, p{};
    for (std::size_t k = 0; k < steps; ++k) {
      const std::array a{0.5 + normal(random) / std::sqrt(dt), bias};
      for (std::size_t i = 0; i < 2; ++i) {
        p[i] += v[i] * dt + 0.5 * a[i] * dt * dt;
        v[i] += a[i] * dt;
      }
      bias += normal(random) * std::sqrt(dt);
    }
    white2 += std::pow(p[0] - 0.5 * v[0] * t_s, 2) / runs;
    walk2 += std::pow(p[1] - 0.5 * v[1] * t_s, 2) / runs;
  }
  const BudgetParts parts =
      distance_between_rests({.white_mps2_rthz = 1.0, .random_walk_mps2_rts = 1.0}, t_s);
  EXPECT_NEAR(std::sqrt(white2) / parts.white_m, 1.0, 0.05);
  EXPECT_NEAR(std::sqrt(walk2) / parts.random_walk_m, 1.0, 0.05);
}

TEST(PositionBudget, FlickerBetweenRestsIsTheIntegralOfItsAutocovariance) {
  constexpr int n = 1500;
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = (i + 0.5) / n - 0.5, y = (j + 0.5) / n - 0.5;
      // The mean of ln |x − y| over a cell on the diagonal is ln h − 3/2.
      sum += x * y * (i == j ? std::log(1.0 / n) - 1.5 : std::log(std::abs(x - y)));
    }
  const double variance = -sum / (static_cast<double>(n) * n) / std::numbers::pi;
  EXPECT_NEAR(distance_between_rests({.flicker_mps2 = 1.0}, 1.0).flicker_m, std::sqrt(variance),
              1e-3);
}

}  // namespace
}  // namespace proofmass::estimate::position_budget_test
