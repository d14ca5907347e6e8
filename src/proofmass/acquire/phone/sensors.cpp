#include "proofmass/acquire/phone/sensors.hpp"

#include <array>

namespace proofmass::acquire {
namespace {

struct Known {
  std::string_view kind, short_name, unit;
  bool has_axes;
};

constexpr std::array known{
    Known{"accelerometer", "acc", "m/s^2", true},
    Known{"accelerometer_uncalibrated", "acc_raw", "m/s^2", true},
    Known{"linear_acceleration", "lin", "m/s^2", true},
    Known{"gravity", "gravity", "m/s^2", true},
    Known{"gyroscope", "gyr", "rad/s", true},
    Known{"gyroscope_uncalibrated", "gyr_raw", "rad/s", true},
    Known{"magnetic_field", "mag", "uT", true},
    Known{"magnetic_field_uncalibrated", "mag_raw", "uT", true},
    Known{"pressure", "pressure", "hPa", false},
    Known{"ambient_temperature", "temperature", "degC", false},
    Known{"temperature", "temperature", "degC", false},
};

}  // namespace

PhoneSensor phone_sensor(std::string_view kind) {
  for (const Known& one : known)
    if (one.kind == kind)
      return {std::string(one.short_name), parse_unit(one.unit).value_or(Unit{}), one.has_axes};
  return {std::string(kind), {}, false};
}

}  // namespace proofmass::acquire
