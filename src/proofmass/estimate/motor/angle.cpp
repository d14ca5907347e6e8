#include "proofmass/estimate/motor/angle.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Centre of the circle through the points, by linear least squares (Kåsa); only its share that the
// arc determines: a ridge holds the rest at zero.
std::array<double, 2> centre_of(const PlaneAxes& axes, double gravity_mps2) {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t k = 0; k < axes[0].size(); ++k) {
    const double x = axes[0][k] / gravity_mps2, y = axes[1][k] / gravity_mps2;
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    const Vector3d row(2.0 * x, 2.0 * y, 1.0);
    A += row * row.transpose();
    b += row * (x * x + y * y);
  }
  const double n = std::max(1.0, 0.25 * A.trace());
  A(0, 0) += 1e-3 * n;
  A(1, 1) += 1e-3 * n;
  const Vector3d centre = solve(A, b);
  return {centre(0) * gravity_mps2, centre(1) * gravity_mps2};
}

// About the centre.
PlaneAxes centred(const PlaneAxes& axes, const std::array<double, 2>& centre) {
  PlaneAxes out = axes;
  for (std::size_t i = 0; i < 2; ++i)
    for (double& f : out[i]) f -= centre[i];
  return out;
}

std::vector<double> unwrapped(const PlaneAxes& axes) {
  std::vector<double> angle;
  double last = 0.0;
  for (std::size_t k = 0; k < axes[0].size(); ++k) {
    const double raw = std::atan2(axes[0][k], axes[1][k]);
    if (std::isfinite(raw)) last += std::remainder(raw - last, rad_per_turn);
    angle.push_back(last);
  }
  return angle;
}

// Adds a further sensor to the sum of those before it, in whose axes gravity has the angles
// `sum_angle`.
void add_sensor(const PlaneAxes& axes, const std::vector<double>& sum_angle, PlaneAxes& sum) {
  const std::vector<double> angle = unwrapped(axes);
  // Seen from the other side the wheel turns the other way.
  const double centre = moments(sum_angle).mean;
  double along = 0.0;
  for (std::size_t k = 0; k < angle.size(); ++k) along += (sum_angle[k] - centre) * angle[k];
  const double sign = along < 0.0 ? -1.0 : 1.0;
  std::vector<double> apart;
  for (std::size_t k = 0; k < angle.size(); ++k) apart.push_back(sign * angle[k] - sum_angle[k]);
  const double offset = median(apart).value_or(0.0), c = std::cos(offset), s = std::sin(offset);
  for (std::size_t k = 0; k < angle.size(); ++k) {
    const double x = sign * axes[0][k], y = axes[1][k];
    sum[0][k] += c * x - s * y;
    sum[1][k] += s * x + c * y;
  }
}

}  // namespace

PlaneAxes plane_of(const std::array<std::vector<double>, 3>& axes) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::array<double, 3> spread{};
  for (std::size_t i = 0; i < 3; ++i) spread[i] = moments(axes[i]).std();
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return spread[a] > spread[b]; });
  const std::size_t one = std::min(order[0], order[1]), two = std::max(order[0], order[1]);
  return {axes[one], axes[two]};
}

Result<std::vector<double>> angle_of(const std::vector<PlaneAxes>& sensors, double gravity_mps2) {
  PlaneAxes sum;
  for (const PlaneAxes& axes : sensors) {
    const double size = std::hypot(moments(axes[0]).std(), moments(axes[1]).std());
    if (size < 0.2 * gravity_mps2)
      return Error{Errc::not_observable,
                   "gravity does not turn in the accelerometers' axes: the axle must be "
                   "horizontal, and the wheel must turn"};
    const PlaneAxes about = centred(axes, centre_of(axes, gravity_mps2));
    if (sum[0].empty())
      sum = about;
    else
      add_sensor(about, unwrapped(sum), sum);
  }
  return unwrapped(sum);
}

}  // namespace proofmass::estimate::motor
