#pragma once

#include <string_view>

namespace proofmass::io {

/// Unit of the figures in a field of a ROS message, "sensor_msgs/Imu.linear_acceleration"; empty
/// where its definition says none. Source: the remarks in sensor_msgs and geometry_msgs; REP 103.
[[nodiscard]] std::string_view ros_unit(std::string_view message_and_field);

}  // namespace proofmass::io
