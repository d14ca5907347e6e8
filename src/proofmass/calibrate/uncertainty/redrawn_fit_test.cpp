#include "proofmass/calibrate/uncertainty/redrawn_fit.hpp"

#include <gtest/gtest.h>

#include "proofmass/calibrate/uncertainty/budget_test_support.hpp"

namespace proofmass::calibrate::redrawn_fit_test {
namespace {

// Covariance of a random walk sampled at the poses, over its standard deviation at the last.
Eigen::MatrixXd walk(std::size_t poses, double std) {
  const auto n = static_cast<Eigen::Index>(poses);
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      out(i, j) = std * std * static_cast<double>(std::min(i, j) + 1) / static_cast<double>(n);
  return out;
}

// Replications by the shortcut against the whole calibration, which searches for bad positions and
// starts from an ellipsoid. The weights are those of the calibration, not of each replication: that
// changes a replication by less than 1 % of its standard deviation.
void expect_whole_calibrations(const std::vector<Pose>& poses,
                               const MultiPositionOptions& options,
                               double tolerance) {
  const MultiPosition fit = calibrate_positions(poses, options).value();
  const DrawnFrom from = drawn_from(poses, options, fit);
  const RedrawnFit refit(from, options, fit);
  MultiPositionOptions again = options;
  again.model = fit.model;
  again.keep_suspects = true;
  again.between = from.between;
  Draw draw(4);
  for (int k = 0; k < 20; ++k) {
    const std::vector<Pose> drawn = redrawn(from, fit, draw);
    again.gravity_mps2 = options.gravity_mps2 + 1e-3 * draw.normal();
    const auto whole = calibrate_positions(drawn, again).value();
    const auto quick = refit(drawn, again.gravity_mps2);
    ASSERT_TRUE(quick.has_value());
    for (Eigen::Index j = 0; j < 9; ++j) {
      const double std = std::sqrt(fit.covariance(j, j));
      const double one = whole.estimate[static_cast<std::size_t>(j)];
      EXPECT_NEAR((*quick)(j), one, tolerance * std + 1e-15) << j;
    }
  }
}

TEST(RedrawnFit, GivesWhatTheWholeCalibrationGives) {
  const auto poses = poses_of(analog_sensor(), noise_v, true, 3);
  expect_whole_calibrations(poses, with_gravity(1e-3, 500.0), 1e-2);
  MultiPositionOptions six = with_gravity(1e-3, 500.0);
  six.model = PoseModel::norm_6;
  expect_whole_calibrations(poses, six, 1e-2);
  six.model = PoseModel::given_12;
  expect_whole_calibrations(poses, six, 0.0);
}

TEST(RedrawnFit, WeighsPosesAlikeWhoseNoiseIsUnknown) {
  expect_whole_calibrations(poses_of(analog_sensor(), noise_v, false, 5), with_gravity(0.0, 0.0),
                            1e-2);
}

TEST(RedrawnFit, HoldsTheCovarianceBetweenThePoses) {
  const auto poses = poses_of(analog_sensor(), noise_v, true, 3);
  MultiPositionOptions options = with_gravity(1e-3, 500.0);
  options.between.fill(walk(poses.size(), 0.7 * noise_v));
  expect_whole_calibrations(poses, options, 1e-2);
}

}  // namespace
}  // namespace proofmass::calibrate::redrawn_fit_test
