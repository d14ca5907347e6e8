#include "proofmass/calibrate/rotating/phase_spline.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {

PhaseSpline::Local PhaseSpline::at(double t_s) const {
  const double x = (t_s - start_s) / step_s;
  const auto last = static_cast<double>(c.size() - 4);
  const double interval = std::clamp(std::floor(x), 0.0, last);
  const double u = x - interval, v = 1.0 - u;
  Local local;
  local.first = static_cast<Eigen::Index>(interval);
  local.value << v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0,
      3.0 * v * v * v - 6.0 * v * v + 4.0, u * u * u;
  local.value /= 6.0;
  local.slope_per_s << -v * v, 3.0 * u * u - 4.0 * u, -3.0 * v * v + 4.0 * v, u * u;
  local.slope_per_s /= 2.0 * step_s;
  return local;
}

PhaseSpline fit_spline(View<double> t_s, View<double> y, std::size_t intervals) {
  PhaseSpline spline;
  spline.start_s = t_s.front();
  spline.step_s = (t_s.back() - t_s.front()) / static_cast<double>(intervals);
  const auto size = static_cast<Eigen::Index>(intervals + 3);
  spline.c = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    const PhaseSpline::Local local = spline.at(t_s[k]);
    A.block<4, 4>(local.first, local.first) += local.value * local.value.transpose();
    b.segment<4>(local.first) += y[k] * local.value;
  }
  spline.c = positive_inverse(A) * b;
  return spline;
}

}  // namespace proofmass::calibrate
