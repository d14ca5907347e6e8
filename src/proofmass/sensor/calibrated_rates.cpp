#include "proofmass/sensor/calibrated_rates.hpp"

#include <Eigen/Core>
#include <cmath>

namespace proofmass::sensor {
namespace {

Eigen::Vector3d si_of(const AxisFigures& figures, double absent_value) {
  Eigen::Vector3d out;
  for (std::size_t axis = 0; axis < 3; ++axis)
    out(static_cast<Eigen::Index>(axis)) = figures[axis] ? figures[axis]->si() : absent_value;
  return out;
}

/// Rotation by a vector. Source: O. Rodrigues (1840); K. Shoemake in Graphics Gems III (1992).
Eigen::Matrix3d rotation_by(const Eigen::Vector3d& r) {
  Eigen::Matrix3d cross;
  cross << 0.0, -r(2), r(1), r(2), 0.0, -r(0), -r(1), r(0), 0.0;
  const double angle = r.norm();
  if (angle < 1e-9) return Eigen::Matrix3d::Identity() + cross;
  return Eigen::Matrix3d::Identity() + std::sin(angle) / angle * cross +
         (1.0 - std::cos(angle)) / (angle * angle) * cross * cross;
}

Eigen::Matrix3d corrector(const Gyroscope& gyroscope) {
  const Eigen::Vector3d scale = si_of(gyroscope.scale, 1.0);
  const Eigen::Vector3d a = si_of(gyroscope.misalignment, 0.0);
  Eigen::Matrix3d T;
  T << 1.0, -a(0), a(1), 0.0, 1.0, -a(2), 0.0, 0.0, 1.0;
  return rotation_by(si_of(gyroscope.alignment, 0.0)) * T * scale.cwiseInverse().asDiagonal();
}

}  // namespace

bool is_calibrated(const Gyroscope& gyroscope) {
  const auto whole = [](const AxisFigures& figures) {
    return figures[0] && figures[1] && figures[2];
  };
  return whole(gyroscope.bias) || whole(gyroscope.scale);
}

std::string reading_unit(const Gyroscope& gyroscope) {
  if (gyroscope.bias[0]) return gyroscope.bias[0]->unit.si_symbol;
  const std::string per = gyroscope.scale[0] ? gyroscope.scale[0]->unit.si_symbol : "1";
  return per == "1" ? "rad/s" : per.substr(0, per.find('/'));
}

std::array<std::array<double, 3>, 3> correction_matrix(const Gyroscope& gyroscope) {
  const Eigen::Matrix3d A = corrector(gyroscope);
  std::array<std::array<double, 3>, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out[i][j] = A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return out;
}

Status apply(const Gyroscope& gyroscope,
             const std::array<std::vector<double>, 3>& accel_mps2,
             std::array<std::vector<double>, 3>& rates) {
  for (const auto& figure : gyroscope.scale)
    if (figure && figure->si() == 0.0)
      return Error{Errc::invalid_argument, "gyroscope.scale: must not be 0"};
  const std::size_t count = rates[0].size();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (rates[axis].size() != count ||
        (!accel_mps2[axis].empty() && accel_mps2[axis].size() != count))
      return Error{Errc::invalid_argument, "gyroscope: axes of different lengths"};
  const Eigen::Matrix3d A = corrector(gyroscope);
  const Eigen::Vector3d bias = si_of(gyroscope.bias, 0.0);
  Eigen::Matrix3d G;
  for (std::size_t row = 0; row < 3; ++row)
    G.row(static_cast<Eigen::Index>(row)) = si_of(gyroscope.g_sensitivity[row], 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!accel_mps2[axis].empty() && !std::isnan(accel_mps2[axis][k]))
        force(static_cast<Eigen::Index>(axis)) = accel_mps2[axis][k];
    const Eigen::Vector3d reading(rates[0][k], rates[1][k], rates[2][k]);
    const Eigen::Vector3d rate = A * (reading - bias - G * force);
    for (std::size_t axis = 0; axis < 3; ++axis)
      rates[axis][k] = rate(static_cast<Eigen::Index>(axis));
  }
  return Done{};
}

}  // namespace proofmass::sensor
