#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/messages/cdr_schema.hpp"

namespace proofmass::io {

/// One step of decoding a message.
struct CdrStep {
  enum class What { figures, text, messages };
  What what = What::figures;
  char kind = 'f';                      ///< for numbers: f, i, u as in NumPy
  std::size_t bytes = 8;                ///< size of one of them
  bool is_sequence = false;             ///< preceded by its length
  std::uint32_t count = 1;              ///< if not a sequence
  std::optional<std::size_t> column{};  ///< column of the first number; none: skipped
  std::vector<CdrStep> inner{};         ///< for nested messages: the steps of each
};

/// A number in a message.
struct CdrColumn {
  std::string path;  ///< "linear_acceleration_x"
  std::string
      parent;  ///< message and field that determine its unit: "sensor_msgs/Imu.angular_velocity"
};

/// How to decode the bytes of a message into columns.
struct CdrPlan {
  std::vector<CdrStep> steps;
  std::vector<CdrColumn> columns;
  /// Columns of a time stamp, seconds and nanoseconds: of the header, else of a field of that name.
  std::optional<std::size_t> stamp;
  std::vector<std::string> skipped;  ///< paths of fields that are not a single number
};

/// Columns for all numbers that occur once in a message: fields of nested messages, arrays of fixed
/// length up to 16, but not covariances.
/// Errors: corrupt (an undefined or recursive message), unsupported (no number; more than 4096
/// fields; wide-character text before the last number).
[[nodiscard]] Result<CdrPlan> plan_cdr(const CdrSchema& schema);

/// Layout of the bytes.
enum class CdrLayout {
  xcdr,  ///< ROS 2: an encapsulation header of 4 bytes, numbers aligned
  ros1,  ///< little-endian, packed
};

/// Decodes a message into its columns. Bytes after them are ignored.
/// Source: OMG, "Extensible and Dynamic Topic Types for DDS", 1.3, section 7.4; ROS 1
/// documentation, "Message serialization". Errors: corrupt (truncated), unsupported (an
/// encapsulation other than plain CDR).
[[nodiscard]] Status decode_cdr(std::string_view message,
                                CdrLayout layout,
                                const CdrPlan& plan,
                                std::span<double> columns);

}  // namespace proofmass::io
