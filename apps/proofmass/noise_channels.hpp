#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/noise_report.hpp"

// From recordings to the series that a noise analysis takes.
namespace proofmass::app {

/// One channel, evenly sampled and in SI where its unit is known, or why it cannot be analysed.
struct NoiseChannel {
  report::ChannelNoise shown;  ///< all but its analysis
  std::vector<double> series;  ///< NaN where a sample is missing; empty if refused
  double rate_hz = 0.0;
  std::optional<double> lsb;        ///< step of the converter, in the series' unit
  std::optional<std::size_t> axis;  ///< 0, 1, 2 for x, y, z of the only accelerometer
  std::string file;
};

/// The channels of all files. Notes of reading and preparing are added to `notes`. Throws Failure.
[[nodiscard]] std::vector<NoiseChannel> noise_channels(const NoiseCommand& command,
                                                       std::vector<Note>& notes);

}  // namespace proofmass::app
