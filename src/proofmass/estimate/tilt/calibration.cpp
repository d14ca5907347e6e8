#include "proofmass/estimate/tilt/calibration.hpp"

#include <cmath>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

double variance_of(const std::optional<sensor::Figure>& figure) {
  if (!figure) return 0.0;
  const double std = figure->std_si().value_or(0.0);
  return std * std;
}

}  // namespace

std::optional<CalibrationSpread> CalibrationSpread::of(const sensor::Calibration& calibration) {
  CalibrationSpread out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (calibration.scale[i]) out.scale_(row) = calibration.scale[i]->si();
    out.cov_(row, row) = variance_of(calibration.bias[i]);
    out.cov_(3 + row, 3 + row) = variance_of(calibration.scale[i]);
    out.cov_(6 + row, 6 + row) = variance_of(calibration.misalignment[i]);
  }
  const auto angle = [&](std::size_t i) {
    return calibration.misalignment[i] ? calibration.misalignment[i]->si() : 0.0;
  };
  out.T_(0, 1) = -angle(0);
  out.T_(0, 2) = angle(1);
  out.T_(1, 2) = -angle(2);
  if (calibration.covariance)
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t j = 0; j < 9; ++j)
        out.cov_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            (*calibration.covariance)[i][j];
  if (!out.cov_.allFinite() || !(out.cov_.trace() > 0.0) || (out.scale_.array() == 0.0).any())
    return std::nullopt;
  if (calibration.dof && calibration.dof->si() > 0.0) {
    const double wider = student_t_quantile(0.975, calibration.dof->si()) / 1.959964;
    out.cov_ *= wider * wider;
  }
  return out;
}

std::optional<double> stability_mps2(const sensor::Calibration& calibration) {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!calibration.stability[i]) continue;
    const double scale = calibration.scale[i] ? calibration.scale[i]->si() : 1.0;
    squares += square(calibration.stability[i]->si() / scale);
    count += 1.0;
  }
  if (count == 0.0 || !std::isfinite(squares)) return std::nullopt;
  return std::sqrt(squares / count);
}

Mat<3, 3> CalibrationSpread::at(const Mat<3>& force) const {
  Mat<3> u;  // T u = f, T being upper triangular with ones
  u.z() = force.z();
  u.y() = force.y() - T_(1, 2) * u.z();
  u.x() = force.x() - T_(0, 1) * u.y() - T_(0, 2) * u.z();
  Mat<3, 9> J = Mat<3, 9>::Zero();
  for (int i = 0; i < 3; ++i) {
    J.col(i) = -T_.col(i) / scale_(i);
    J.col(3 + i) = -T_.col(i) * (u(i) / scale_(i));
  }
  J(0, 6) = -u.y();
  J(0, 7) = u.z();
  J(1, 8) = -u.z();
  return J * cov_ * J.transpose();
}

}  // namespace proofmass::estimate
