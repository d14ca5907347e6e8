#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// One sample in the format of the app SensorServer. Source: github.com/UmerCodez/SensorServer,
/// README.
struct SensorMessage {
  std::string type{};             ///< "android.sensor.gyroscope"; empty if one sensor was requested
  std::int64_t timestamp_ns = 0;  ///< since the phone's start
  int accuracy = -1;              ///< Android's accuracy: 0 is unreliable, 3 the best; -1 unknown
  std::vector<double> values{};   ///< NaN for values that are not numbers
};

/// `out` keeps its capacity. Errors: corrupt (not JSON, no timestamp, no values).
[[nodiscard]] Status parse_sensor_message(std::string_view text, SensorMessage& out);

}  // namespace proofmass::acquire
