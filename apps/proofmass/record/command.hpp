#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "cli/common_flags.hpp"

namespace proofmass::app {

/// Flags of a guided procedure and of its evaluation.
struct GuideFlags {
  std::string procedure;                 ///< tumble, multi-position or static; empty: none
  std::optional<std::size_t> positions;  ///< --positions
  std::optional<double> target_std_mg;   ///< --target-std
  std::optional<double> minutes;         ///< --minutes, for static
  std::string update_sensor;             ///< for the verb that evaluates the recording
};

/// Records live samples; with `list`, shows the available sources.
struct RecordCommand {
  std::string source;
  bool list = false;
  bool stream = false;   ///< lines of JSON on standard output
  bool no_file = false;  ///< nothing is recorded
  std::optional<double> duration_s, rotate_s, rotate_mb;
  std::string trigger;  ///< "acc_x > 2"
  double trigger_before_s = 1.0, trigger_after_s = 1.0;
  bool reconnect = false;
  double stall_s = 2.0, stall_end_s = 30.0;
  std::string estimate;  ///< wheel, track or tilt; empty: none
  std::string send_to;   ///< address for the estimates: udp:HOST:PORT or unix:PATH; empty: none
  GuideFlags guide;
  std::optional<double> lag_s, radius_m, rolling_radius_m, bandwidth_hz;
  bool no_gyro = false;
  std::string rate_unit = "rad/s";  ///< of a gyroscope without a unit
  std::string axis;                 ///< axle of the wheel, or direction of the motion
  InputFlags input;                 ///< rate, unit, channels, sensors, supply and gravity
  OutputFlags output;
};

}  // namespace proofmass::app
