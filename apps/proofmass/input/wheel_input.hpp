#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "input/encoder.hpp"
#include "input/gyroscope.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/sensor/calibrated_channels.hpp"

// Accelerometers from one or two recordings of a rotating wheel.
namespace proofmass::app {

struct WheelInput {
  std::vector<estimate::WheelSensor> sensors;
  bool clocks_shared = true;
  double alignment_std_rad = 0.0;
  std::optional<double> bandwidth_hz{};  ///< from the sensor file
  std::optional<estimate::WheelEncoder> encoder{};
  std::vector<Note> notes;
};

/// Use of a gyroscope's channels.
struct GyroscopeUse {
  bool wanted = true;
  std::string unit_if_unknown = "rad/s";
  /// Those of another accelerometer, not used twice: their noise would count as two measurements'.
  std::optional<GyroscopeChannels> taken{};
};

/// An accelerometer with its gyroscope, calibrated by `model` unless that is null; sample k is at
/// begin_s + time.at(k). Throws Failure.
[[nodiscard]] estimate::WheelSensor wheel_sensor(const Recording& recording,
                                                 const sensor::Accelerometer& from,
                                                 double begin_s,
                                                 const GyroscopeUse& gyroscope,
                                                 const sensor::SensorModel* model,
                                                 std::vector<Note>& notes);

/// One or two accelerometers of one run, calibrated and in m/s^2, with their gyroscopes, and the
/// encoder in the first file, if wanted. Throws Failure.
[[nodiscard]] WheelInput wheel_input(const std::vector<std::string>& files,
                                     const InputFlags& flags,
                                     const GyroscopeUse& gyroscope,
                                     const EncoderFlags& encoder,
                                     const OutputFlags& output);

}  // namespace proofmass::app
