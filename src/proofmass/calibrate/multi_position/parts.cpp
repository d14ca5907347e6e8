#include "proofmass/calibrate/multi_position/parts.hpp"

#include <cmath>

namespace proofmass::calibrate {

UncertaintyShare gravity_share(const Parameters& estimate, const MultiPositionOptions& options) {
  Parameters pull = Parameters::Zero();
  pull.segment<3>(3) = estimate.segment<3>(3) * (options.gravity_std_mps2 / options.gravity_mps2);
  return {"gravity", false, pull * pull.transpose(), 0.0};
}

void set_estimate(const Parameters& estimate, bool with_misalignment, MultiPosition& out) {
  out.covariance.setZero();
  for (const UncertaintyShare& share : out.shares) out.covariance += share.covariance;
  // Sums of products in another order differ in the last digit.
  out.covariance = (0.5 * (out.covariance + out.covariance.transpose())).eval();
  for (Eigen::Index k = 0; k < 9; ++k) {
    const auto axis = static_cast<std::size_t>(k % 3);
    const Uncertain figure{estimate(k), std::sqrt(out.covariance(k, k))};
    out.estimate[static_cast<std::size_t>(k)] = estimate(k);
    if (k < 3) out.bias[axis] = figure;
    if (k >= 3 && k < 6) out.scale[axis] = figure;
    if (k >= 6 && with_misalignment) out.misalignment_rad[axis] = figure;
  }
}

void set_residual_sums(MultiPosition& out) {
  double residuals = 0.0, left_out = 0.0;
  std::size_t used = 0, judged = 0;
  for (const PoseResidual& pose : out.poses) {
    if (!pose.used) continue;
    ++used;
    residuals += pose.residual_mps2 * pose.residual_mps2;
    if (!pose.leave_one_out_mps2) continue;
    ++judged;
    left_out += *pose.leave_one_out_mps2 * *pose.leave_one_out_mps2;
  }
  if (used > 0) out.residual_rms_mps2 = std::sqrt(residuals / static_cast<double>(used));
  if (judged > 0) out.leave_one_out_rms_mps2 = std::sqrt(left_out / static_cast<double>(judged));
}

}  // namespace proofmass::calibrate
