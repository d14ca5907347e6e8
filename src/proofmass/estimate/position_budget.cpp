#include "proofmass/estimate/position_budget.hpp"

#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/sensor/grades.hpp"

namespace proofmass::estimate {
namespace {

BudgetError error_after(double t_s, const BudgetSensor& sensor) {
  PM_EXPECTS(t_s >= 0.0);
  const double half_t2 = 0.5 * t_s * t_s;
  const double from_noise = sensor.white_noise_mps2_rthz * std::sqrt(t_s * t_s * t_s / 3.0);
  return {
      t_s,
      {sensor.bias_mps2.value * half_t2, std::hypot(sensor.bias_mps2.std * half_t2, from_noise)}};
}

}  // namespace

std::vector<BudgetRow> position_budget(View<BudgetSensor> sensors, View<double> times_s) {
  std::vector<BudgetRow> rows;
  rows.reserve(sensors.size());
  for (const BudgetSensor& sensor : sensors) {
    BudgetRow& row = rows.emplace_back(BudgetRow{sensor.name, sensor.bias_mps2, {}});
    for (const double t_s : times_s) row.errors.push_back(error_after(t_s, sensor));
  }
  return rows;
}

std::vector<BudgetSensor> grade_sensors() {
  std::vector<BudgetSensor> sensors;
  sensors.reserve(sensor::grades.size());
  for (const sensor::Grade& grade : sensor::grades)
    sensors.push_back({.name = std::string(grade.name), .bias_mps2 = {grade.bias_mps2, 0.0}});
  return sensors;
}

}  // namespace proofmass::estimate
