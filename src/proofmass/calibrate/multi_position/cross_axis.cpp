#include "proofmass/calibrate/multi_position/cross_axis.hpp"

namespace proofmass::calibrate {

std::array<std::optional<CrossAxis>, 3> cross_axis_of(const MultiPosition& fit) {
  std::array<std::optional<CrossAxis>, 3> out;
  if (!fit.misalignment_rad[0]) return out;
  const double yz = fit.estimate[6], zy = fit.estimate[7], zx = fit.estimate[8];
  const Eigen::Matrix3d C = fit.covariance.bottomRightCorner<3, 3>();
  std::array<Eigen::Vector2d, 2> across{Eigen::Vector2d(yz, yz * zx - zy),
                                        Eigen::Vector2d(0.0, zx)};
  std::array<Eigen::Matrix<double, 2, 3>, 2> slope;
  slope[0] << 1.0, 0.0, 0.0, zx, -1.0, yz;
  slope[1] << 0.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Result<CrossAxis> found =
        cross_axis_sensitivity(across[axis], slope[axis] * C * slope[axis].transpose(), fit.dof);
    if (found) out[axis] = *found;
  }
  return out;
}

}  // namespace proofmass::calibrate
