#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A field of a ROS message.
struct CdrField {
  enum class Many { one, array, sequence };
  std::string name;
  std::string type;  ///< "float64", "string", or a message's full name: "geometry_msgs/Vector3"
  Many many = Many::one;
  std::uint32_t count = 1;  ///< for an array
};

/// Messages by their full names, "package/Name", each with its fields in order.
struct CdrSchema {
  std::string root;
  std::map<std::string, std::vector<CdrField>> messages;
};

/// "sensor_msgs/msg/Imu" as "sensor_msgs/Imu".
[[nodiscard]] std::string ros_name(std::string_view name);

/// Parses a message definition of ROS 1 or 2 with the nested definitions that follow it, each below
/// a line of '=' and one "MSG: package/Name". Constants and comments are skipped; "time",
/// "duration" and builtin_interfaces' Time and Duration are predefined.
/// Source: MCAP format registry, "ros2msg"; ROS 2 documentation, "Interfaces".
/// Errors: corrupt, with the line.
[[nodiscard]] Result<CdrSchema> read_cdr_schema(std::string_view name, std::string_view text);

}  // namespace proofmass::io
