#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/units.hpp"

namespace proofmass::acquire {

/// What both apps know of a kind of sensor, by Android's name for it without "android.sensor.".
struct PhoneSensor {
  std::string short_name;  ///< "acc"; the kind itself where there is no usual one
  Unit unit;               ///< Quantity::unknown where nobody says
  bool has_axes = false;   ///< its first three values are x, y, z
};

/// Source: developer.android.com, SensorEvent.values.
[[nodiscard]] PhoneSensor phone_sensor(std::string_view kind);

}  // namespace proofmass::acquire
