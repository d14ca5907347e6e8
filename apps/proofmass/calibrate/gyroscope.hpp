#pragma once

#include <vector>

#include "calibrate/poses.hpp"
#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/recording_poses.hpp"

// `calibrate --gyro`: from recordings to the gyroscope's calibration.
namespace proofmass::app {

/// The gyroscope's readings beside the rests of a recording, in rad/s, V or counts, and that unit.
/// It is in the recording, or in the file of --gyro-file. Throws Failure.
[[nodiscard]] RateSession rate_session(const Recording& recording,
                                       const calibrate::RecordingPoses& found,
                                       const CalibrateCommand& command,
                                       std::vector<Note>& notes);

/// Calibrates the gyroscope of these poses into the report, whose accelerometer is fitted already.
/// Throws Failure.
void calibrate_gyroscope(const CalibrateCommand& command,
                         const PoseSet& set,
                         report::CalibrateReport& report);

/// Writes it into the sensor file of --update-sensor.
void update_gyroscope(const CalibrateCommand& command, const report::CalibrateReport& report);

}  // namespace proofmass::app
