#pragma once

#include <string_view>

// Key-value metadata that Proofmass writes to a Parquet file beside its columns.
namespace proofmass::io::parquet {

inline constexpr std::string_view rate_key = "sample_rate_hz";  ///< rate of an even time base
inline constexpr std::string_view start_key = "start_time_ns";  ///< time of row 0, on its own clock
inline constexpr std::string_view time_key = "time_column";     ///< seconds since row 0
inline constexpr std::string_view unit_prefix = "unit.";        ///< "unit.acc_x": "m/s^2"
inline constexpr std::string_view name_prefix = "name.";        ///< if it differs from the column's
inline constexpr std::string_view labels_key = "labels";        ///< lines "first last text"
inline constexpr std::string_view label_channel_key = "label_channel";

}  // namespace proofmass::io::parquet
