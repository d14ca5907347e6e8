#include "proofmass/calibrate/guide/turned_axes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {

void TurnedAxes::add(double angle_rad, const Eigen::Vector3d& mean) {
  angles_rad_.push_back(angle_rad);
  means_.push_back(mean);
  fit();
}

void TurnedAxes::fit() {
  // Over less than a quarter of a turn the constant is not separable from the cosine: where the
  // unit is known it is taken for zero till then.
  constexpr double quarter = 89.0 * rad_per_deg;
  const double span =
      *std::ranges::max_element(angles_rad_) - *std::ranges::min_element(angles_rad_);
  const bool with_constant = span >= quarter && angles_rad_.size() >= 4;
  if (!with_constant && (!given_one_g_ || angles_rad_.size() < 2)) return;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < angles_rad_.size(); ++k) {
    const Eigen::Vector3d row(with_constant ? 1.0 : 0.0, std::sin(angles_rad_[k]),
                              std::cos(angles_rad_[k]));
    normal += row * row.transpose();
    right += row * means_[k].transpose();
  }
  if (!with_constant) normal(0, 0) = 1.0;
  follows_ = (positive_inverse(normal) * right).transpose();
}

std::optional<double> TurnedAxes::angle_rad(const Eigen::Vector3d& mean) const {
  if (axes_ < 2 || angles_rad_.empty()) return std::nullopt;
  if (!follows_) {
    // From the first position, whichever way the table is turned.
    if (!given_one_g_ || angles_rad_.size() != 1) return std::nullopt;
    const Eigen::Vector3d& first = means_.front();
    return angles_rad_.front() + std::atan2(first.cross(mean).norm(), first.dot(mean));
  }
  const Eigen::Matrix<double, 3, 2> response = follows_->rightCols<2>();
  const Eigen::Matrix2d normal = response.transpose() * response;
  const Eigen::Vector2d part =
      positive_inverse(normal) * (response.transpose() * (mean - follows_->col(0)));
  return std::atan2(part(0), part(1));
}

std::optional<double> TurnedAxes::one_g() const {
  if (given_one_g_) return given_one_g_;
  if (!follows_) return std::nullopt;
  return follows_->rightCols<2>().rowwise().norm().maxCoeff();
}

}  // namespace proofmass::calibrate
