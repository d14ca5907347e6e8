#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// The gyroscope that belongs to an accelerometer.
namespace proofmass::app {

/// Channels x, y and z of a recording.
using GyroscopeChannels = std::array<std::size_t, 3>;

/// The three channels of angular rate that belong to the accelerometer: those with the matching
/// name ("imu_acc_x" and "imu_gyr_x", "acc1_x" and "gyro1_x"), else the only ones in the recording.
/// Their unit is one of angular rate, or unknown with a gyroscope's name. nullopt if there are
/// none.
[[nodiscard]] std::optional<GyroscopeChannels> find_gyroscope(const Recording& recording,
                                                              const Triad& accelerometer);

/// The measured rates in rad/s. If the headings have no unit, `unit_if_unknown` ("rad/s", "deg/s")
/// is assumed, with a note.
[[nodiscard]] std::array<std::vector<double>, 3> rates_radps(const Recording& recording,
                                                             const GyroscopeChannels& channels,
                                                             const std::string& unit_if_unknown,
                                                             std::vector<Note>& notes);

/// The same, calibrated by the sensor file if it has a gyroscope: `accel_mps2` is the calibrated
/// specific force beside it. Channels without a unit are then in that of the calibration. Throws
/// Failure (a calibration of volts or counts for channels in a unit of angular rate).
[[nodiscard]] std::array<std::vector<double>, 3> calibrated_rates_radps(
    const Recording& recording,
    const GyroscopeChannels& channels,
    const sensor::SensorModel* model,
    const std::array<std::vector<double>, 3>& accel_mps2,
    const std::string& unit_if_unknown,
    std::vector<Note>& notes);

/// Makes values of an accelerometer, and of the gyroscope beside it, NaN where they are stuck or at
/// an end of the range, with warnings; before any calibration, which mixes the axes.
void drop_unusable(const Triad& accelerometer,
                   const std::optional<GyroscopeChannels>& gyroscope,
                   Recording& recording,
                   std::vector<Note>& notes);

/// The model of accelerometer `at` of --sensor: one for all or one for each; nullptr without.
[[nodiscard]] const sensor::SensorModel* sensor_model_of(
    const std::vector<sensor::SensorModel>& models, std::size_t at);

}  // namespace proofmass::app
