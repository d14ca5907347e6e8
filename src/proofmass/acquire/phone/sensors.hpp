#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/units.hpp"

namespace proofmass::acquire {

/// What both apps have in common for a type of sensor, by Android's name without "android.sensor.".
struct PhoneSensor {
  std::string short_name;  ///< "acc"; the type itself if there is no usual one
  Unit unit;               ///< Quantity::unknown if not documented
  bool has_axes = false;   ///< its first three values are x, y, z
};

/// Source: developer.android.com, SensorEvent.values.
[[nodiscard]] PhoneSensor phone_sensor(std::string_view kind);

}  // namespace proofmass::acquire
