#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// What the app SensorServer says of one sample.
/// Source: github.com/UmerCodez/SensorServer, README.
struct SensorMessage {
  std::string type{};  ///< "android.sensor.gyroscope"; empty where one sensor was asked for
  std::int64_t timestamp_ns = 0;  ///< since the phone's start
  int accuracy = -1;              ///< Android's grade: 0 is unreliable, 3 the best; -1 unknown
  std::vector<double> values{};   ///< NaN for what is no number
};

/// `out` keeps its memory. Errors: corrupt (no JSON, no timestamp, no values).
[[nodiscard]] Status parse_sensor_message(std::string_view text, SensorMessage& out);

}  // namespace proofmass::acquire
