#pragma once

#include <string>
#include <vector>

#include "calibrate_command.hpp"
#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/calibrate/session_noise.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/calibrate_report.hpp"

// From files to poses at rest.
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
  std::string sensor;                  ///< what the three channels' names share
  Unit unit;                           ///< SI: m/s^2, V or counts
  /// Supply at which the readings in volts would have been these, brought there by a recorded one.
  std::optional<double> reference_supply_v;
  double noise_dof = 0.0;                         ///< of the poses' covariances; 0: not known
  std::vector<calibrate::RestSession> sessions;   ///< one for each recording; none of tables
  std::array<Eigen::MatrixXd, 3> between;         ///< MultiPositionOptions::between
  std::optional<calibrate::SessionNoise> wander;  ///< where the recordings show it
  std::array<double, 3> sample_std{};
  std::vector<RateSession> rates;  ///< with --gyro, one for each recording
};

/// Reads tables of means as they are, and of recordings the rests: listed by --rests, by the file's
/// labels where these are names of positions, else found. Notes are added. Throws Failure, also
/// where the files do not agree in the unit of the reading.
[[nodiscard]] PoseSet read_poses(const std::vector<std::string>& files,
                                 const CalibrateCommand& command,
                                 std::vector<Note>& notes);

}  // namespace proofmass::app
