// The gyroscope of the imu_tk recording, by the program's own path, against imu_tk's answer. See
// published_data.hpp.
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <vector>

#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/signal/rests.hpp"
#include "published_data.hpp"

namespace proofmass::gyroscope_real_test {
namespace {

using Axes = std::array<std::vector<double>, 3>;

Axes axes_of(const Recording& recording) {
  return {recording.channels.at(0).values.copy(), recording.channels.at(1).values.copy(),
          recording.channels.at(2).values.copy()};
}

calibrate::GyroscopeCalibration imu_tk_fit(const std::filesystem::path& folder) {
  const io::ReadOptions counts{.unit = parse_unit("counts").value()};
  const Recording accel =
      io::read_recording((folder / "xsens_acc.mat.xz").string(), counts).value();
  const Recording gyro =
      io::read_recording((folder / "xsens_gyro.mat.xz").string(), counts).value();
  calibrate::GyroscopeSession session{
      .time_s = {}, .rate = axes_of(gyro), .accel = axes_of(accel), .rests = {}, .poses = {}};
  for (std::size_t n = 0; n < accel.samples(); ++n) session.time_s.push_back(accel.time.at(n));
  const std::array<View<double>, 3> views{session.accel[0], session.accel[1], session.accel[2]};
  for (const signal::Rest& rest : signal::find_rests(views, {.rate_hz = accel.time.rate_hz}).rests)
    session.rests.push_back({rest.first, rest.last});
  session.rate_lsb = {1.0, 1.0, 1.0};
  const calibrate::PoseMeans means =
      calibrate::pose_means(views, session.rests, {1.0, 1.0, 1.0}).value();
  session.poses = means.poses;
  session.pose_noise_dof = means.noise_dof;
  const calibrate::MultiPosition accelerometer =
      calibrate::calibrate_positions(means.poses,
                                     {.gravity_mps2 = 9.81744, .noise_dof = means.noise_dof})
          .value();
  return calibrate::calibrate_gyroscope({&session, 1}, accelerometer, {.in_radps = false}).value();
}

// imu_tk's algorithm (its intervals, its Runge–Kutta integration, its unweighted cost), programmed
// apart from this project on the same files: T K in its notation.
TEST(GyroscopeOfImuTk, HasTheMatrixOfItsOwnAlgorithm) {
  const auto folder = published_data() / "imu-tk-xsens";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << absent(folder);
  const calibrate::GyroscopeCalibration fit = imu_tk_fit(folder);
  ASSERT_TRUE(fit.converged);
  const Eigen::Matrix3d imu_tk{{2.09293857e-04, 1.24292880e-06, 1.84530084e-07},
                               {1.70773680e-06, 2.09888322e-04, -1.11911625e-05},
                               {5.38649238e-06, -5.35643192e-07, 2.09511740e-04}};
  const double size = 1.0 / 4778.0;
  // Its own residuals make its standard deviations 1.0 to 1.7e-3.
  const Eigen::Matrix3d difference = (fit.matrix - imu_tk) / size;
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 3e-3) << fit.matrix;
  for (std::size_t k = 0; k < 12; ++k) ASSERT_TRUE(fit.parameter(k)) << fit.why_absent[k];
}

}  // namespace
}  // namespace proofmass::gyroscope_real_test
