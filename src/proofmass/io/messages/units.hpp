#pragma once

#include <string_view>

namespace proofmass::io {

/// Unit of a field of a ROS message, "sensor_msgs/Imu.linear_acceleration"; empty if its definition
/// has none. Source: the comments in sensor_msgs and geometry_msgs; REP 103.
[[nodiscard]] std::string_view ros_unit(std::string_view message_and_field);

}  // namespace proofmass::io
