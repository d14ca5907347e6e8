#include "proofmass/io/messages/units.hpp"

#include <algorithm>
#include <array>

namespace proofmass::io {
namespace {

struct FieldUnit {
  std::string_view field;
  std::string_view unit;
};
constexpr std::array fields = std::to_array<FieldUnit>({
    {"sensor_msgs/Imu.linear_acceleration", "m/s^2"},
    {"sensor_msgs/Imu.angular_velocity", "rad/s"},
    {"sensor_msgs/MagneticField.magnetic_field", "T"},
    {"sensor_msgs/Temperature.temperature", "degC"},
    {"sensor_msgs/FluidPressure.fluid_pressure", "Pa"},
    {"sensor_msgs/Range.range", "m"},
    {"sensor_msgs/BatteryState.voltage", "V"},
    {"sensor_msgs/NavSatFix.latitude", "deg"},
    {"sensor_msgs/NavSatFix.longitude", "deg"},
    {"sensor_msgs/NavSatFix.altitude", "m"},
    {"geometry_msgs/Accel.linear", "m/s^2"},
    {"geometry_msgs/Twist.linear", "m/s"},
    {"geometry_msgs/Twist.angular", "rad/s"},
    {"geometry_msgs/Pose.position", "m"},
    {"geometry_msgs/Transform.translation", "m"},
});

}  // namespace

std::string_view ros_unit(std::string_view message_and_field) {
  const auto* found = std::ranges::find(fields, message_and_field, &FieldUnit::field);
  return found == fields.end() ? std::string_view{} : found->unit;
}

}  // namespace proofmass::io
