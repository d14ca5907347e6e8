#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/cdr_schema.hpp"

namespace proofmass::io {

/// One step through the bytes of a message.
struct CdrStep {
  enum class What { figures, text, messages };
  What what = What::figures;
  char kind = 'f';                      ///< of figures: f, i, u as in NumPy
  std::size_t bytes = 8;                ///< of one of them
  bool is_sequence = false;             ///< its length stands in front of it
  std::uint32_t count = 1;              ///< otherwise
  std::optional<std::size_t> column{};  ///< of the first figure; none: passed over
  std::vector<CdrStep> inner{};         ///< of messages: through each of them
};

/// A figure of a message.
struct CdrColumn {
  std::string path;  ///< "linear_acceleration_x"
  std::string
      parent;  ///< message and field that its unit hangs on: "sensor_msgs/Imu.angular_velocity"
};

/// How to get from the bytes of a message to the figures of its columns.
struct CdrPlan {
  std::vector<CdrStep> steps;
  std::vector<CdrColumn> columns;
  /// Columns of a time stamp, seconds and nanoseconds: of the header, else of a field called so.
  std::optional<std::size_t> stamp;
  std::vector<std::string> skipped;  ///< paths of what is no single figure
};

/// Columns for all figures that a message has once: fields of messages within it, arrays of a fixed
/// length of at most 16, but not covariances.
/// Errors: corrupt (a message that is not defined, or holds itself), unsupported (no figure; more
/// than 4096 fields; text of wide characters before the last figure).
[[nodiscard]] Result<CdrPlan> plan_cdr(const CdrSchema& schema);

/// How the bytes are laid out.
enum class CdrLayout {
  xcdr,  ///< of ROS 2: an encapsulation's head of 4 bytes, figures aligned
  ros1,  ///< little-endian, one after another
};

/// Puts the figures of a message into its columns. What stands behind them is not looked at.
/// Source: OMG, "Extensible and Dynamic Topic Types for DDS", 1.3, section 7.4; ROS 1
/// documentation, "Message serialization". Errors: corrupt (breaks off), unsupported (an
/// encapsulation other than plain CDR).
[[nodiscard]] Status decode_cdr(std::string_view message,
                                CdrLayout layout,
                                const CdrPlan& plan,
                                std::span<double> columns);

}  // namespace proofmass::io
