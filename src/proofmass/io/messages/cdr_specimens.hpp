#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

// Writes ROS messages for tests.
namespace proofmass::io::specimen {

inline constexpr std::string_view imu_definition = R"(# An inertial sensor
std_msgs/Header header

geometry_msgs/Quaternion orientation
float64[9] orientation_covariance # row major, -1 if unknown
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";

/// Writes aligned CDR numbers, of either byte order.
class CdrWriter {
 public:
  explicit CdrWriter(bool big_endian = false, std::size_t alignment = 8, bool second = false)
      : big_endian_(big_endian), alignment_(alignment) {
    head_ = {'\0', static_cast<char>((second ? 6 : 0) + (big_endian ? 0 : 1)), '\0', '\0'};
  }

  template <class T>
  CdrWriter& put(T value) {
    while (body_.size() % std::min(sizeof(T), alignment_) != 0) body_ += '\xEE';
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian_ == (std::endian::native == std::endian::little)) std::ranges::reverse(bytes);
    body_.append(bytes.data(), bytes.size());
    return *this;
  }
  CdrWriter& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    body_ += value;
    body_ += '\0';
    return *this;
  }
  [[nodiscard]] std::string message() const { return std::string(head_.data(), 4) + body_; }
  [[nodiscard]] const std::string& body() const { return body_; }

 private:
  bool big_endian_;
  std::size_t alignment_;
  std::array<char, 4> head_{};
  std::string body_;
};

/// An Imu message at rest, with values derived from `k`.
inline std::string imu_message(int k, std::int64_t stamp_ns, CdrWriter out = CdrWriter()) {
  out.put(static_cast<std::int32_t>(stamp_ns / 1'000'000'000))
      .put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000))
      .text("imu");
  for (int i = 0; i < 4; ++i) out.put(i == 3 ? 1.0 : 0.0);
  for (int i = 0; i < 9; ++i) out.put(-1.0);
  for (int i = 0; i < 3; ++i) out.put(0.01 * (i + 1));
  for (int i = 0; i < 9; ++i) out.put(0.0);
  out.put(0.001 * k).put(-0.5).put(9.81);
  for (int i = 0; i < 9; ++i) out.put(0.0);
  return out.message();
}

}  // namespace proofmass::io::specimen
