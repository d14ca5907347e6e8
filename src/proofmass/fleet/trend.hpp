#pragma once

#include <optional>
#include <vector>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/quantity.hpp"

namespace proofmass::fleet {

/// A figure of one recording at what it may depend on: a date in days, a temperature.
struct TrendPoint {
  std::size_t sensor = 0;
  double x = 0.0, y = 0.0;
};

struct Trend {
  Uncertain slope;  ///< change of y per unit of x
  Bounds slope_95;
  double p = 1.0;              ///< p-value of no dependence
  bool within_sensors = true;  ///< false: no sensor was measured at two x, so that sensors' own
                               ///< differences and the dependence are not separable
};

/// Least squares with a level for each sensor and one slope for all: y_ij = a_i + b x_ij + e_ij.
/// Where that leaves fewer than three degrees of freedom, one level for all. nullopt where x does
/// not vary or points are too few.
[[nodiscard]] std::optional<Trend> fit_trend(const std::vector<TrendPoint>& points);

}  // namespace proofmass::fleet
