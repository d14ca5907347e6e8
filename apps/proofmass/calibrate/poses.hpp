#pragma once

#include <string>
#include <vector>

#include "calibrate/command.hpp"
#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/calibrate/session_noise.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/calibrate/report.hpp"

// Poses at rest from files.
namespace proofmass::app {

/// The gyroscope's readings during one recording.
struct RateSession {
  calibrate::GyroscopeSession session;  ///< without poses
  Unit unit;                            ///< rad/s, V or counts
  std::size_t file = 0;                 ///< index into PoseSet::files
};

/// The poses of one or more files.
struct PoseSet {
  std::vector<report::PoseFile> files;
  std::vector<calibrate::Pose> poses;
  std::vector<std::size_t> pose_file;  ///< index into files
  std::string sensor;                  ///< common part of the three channels' names
  Unit unit;                           ///< SI: m/s^2, V or counts
  /// Reference supply to which measurements in volts were scaled by a recorded supply.
  std::optional<double> reference_supply_v;
  double noise_dof = 0.0;                             ///< of the poses' covariances; 0 if unknown
  std::vector<calibrate::RestSession> sessions;       ///< one for each recording; none for tables
  std::array<Eigen::MatrixXd, 3> between;             ///< MultiPositionOptions::between
  std::optional<calibrate::SessionNoise> slow_noise;  ///< present if the recordings determine it
  std::array<double, 3> sample_std{};
  std::vector<RateSession> rates;  ///< with --gyro, one for each recording
};

/// Reads tables of means, and from recordings the rests: those listed by --rests, those that the
/// file's labels name as positions, or else detected ones. Notes are added. Throws Failure, also if
/// the files differ in the unit of the measurement.
[[nodiscard]] PoseSet read_poses(const std::vector<std::string>& files,
                                 const CalibrateCommand& command,
                                 std::vector<Note>& notes);

}  // namespace proofmass::app
