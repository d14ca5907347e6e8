#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "proofmass/core/view.hpp"

namespace proofmass::calibrate {

/// A cubic spline on even knots: Σ c_j B_j(t).
struct PhaseSpline {
  double start_s = 0.0, step_s = 1.0;
  Eigen::VectorXd c;  ///< intervals + 3

  /// The four basis functions that are not zero at t, from c(first) on, and their slopes.
  struct Local {
    Eigen::Index first = 0;
    Eigen::Vector4d value, slope_per_s;
  };
  [[nodiscard]] Local at(double t_s) const;
  [[nodiscard]] double value(const Local& local) const {
    return local.value.dot(c.segment<4>(local.first));
  }
  [[nodiscard]] double slope_per_s(const Local& local) const {
    return local.slope_per_s.dot(c.segment<4>(local.first));
  }
};

/// Least-squares spline over the points' range with `intervals` intervals; needs two more points
/// than intervals + 3. Cost: O(points + intervals³).
[[nodiscard]] PhaseSpline fit_spline(View<double> t_s, View<double> y, std::size_t intervals);

}  // namespace proofmass::calibrate
