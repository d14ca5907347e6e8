#include "proofmass/estimate/position_budget.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/sensor/grades.hpp"

namespace proofmass::estimate {
namespace {

// Variance over B² of flicker's mean over a time, weighted as in double integration.
double flicker_share(double t_s) {
  constexpr double hour_s = 3600.0, periods = 10.0, weighed = 1.75;
  const double longest_s = std::max(hour_s, periods * t_s);
  return (std::log(longest_s / (2.0 * std::numbers::pi * t_s)) + weighed - std::numbers::egamma) /
         std::numbers::pi;
}

BudgetError error_after(double t_s, const BudgetSensor& sensor) {
  PM_EXPECTS(t_s >= 0.0);
  const double t3 = t_s * t_s * t_s, half_t2 = 0.5 * t_s * t_s;
  const BudgetNoise& noise = sensor.noise;
  const double flicker = t_s > 0.0 ? std::sqrt(flicker_share(t_s)) : 0.0;
  const BudgetParts parts{
      sensor.bias_mps2.std * half_t2, noise.white_mps2_rthz * std::sqrt(t3 / 3.0),
      noise.flicker_mps2 * flicker * half_t2,
      noise.random_walk_mps2_rts * std::sqrt(t3 * t_s * t_s / 20.0), noise.ramp_mps3 * t3 / 6.0};
  const double std_m = std::hypot(std::hypot(parts.bias_m, parts.white_m, parts.flicker_m),
                                  parts.random_walk_m, parts.ramp_m);
  return {t_s, {sensor.bias_mps2.value * half_t2, std_m}, parts};
}

}  // namespace

std::vector<BudgetRow> position_budget(View<BudgetSensor> sensors, View<double> times_s) {
  std::vector<BudgetRow> rows;
  rows.reserve(sensors.size());
  for (const BudgetSensor& sensor : sensors) {
    BudgetRow& row = rows.emplace_back(BudgetRow{sensor.name, sensor.bias_mps2, {}, sensor.noise});
    for (const double t_s : times_s) row.errors.push_back(error_after(t_s, sensor));
  }
  return rows;
}

BudgetParts distance_between_rests(const BudgetNoise& noise, double t_s) {
  PM_EXPECTS(t_s >= 0.0);
  const double t3 = t_s * t_s * t_s;
  return {.bias_m = 0.0,
          .white_m = noise.white_mps2_rthz * std::sqrt(t3 / 12.0),
          .flicker_m = noise.flicker_mps2 * t_s * t_s / std::sqrt(16.0 * std::numbers::pi),
          .random_walk_m = noise.random_walk_mps2_rts * std::sqrt(t3 * t_s * t_s / 120.0),
          .ramp_m = 0.0};
}

std::vector<BudgetSensor> grade_sensors() {
  std::vector<BudgetSensor> sensors;
  sensors.reserve(sensor::grades.size());
  for (const sensor::Grade& grade : sensor::grades)
    sensors.push_back({.name = std::string(grade.name), .bias_mps2 = {grade.bias_mps2, 0.0}});
  return sensors;
}

}  // namespace proofmass::estimate
