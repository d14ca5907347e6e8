#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"

namespace proofmass::app {

struct NoiseCommand {
  std::vector<std::string> files;
  std::string statistic = "oadev", taus, data = "rate", noise_type = "auto";
  std::string temperature, update_sensor;
  double confidence = 0.683;
  std::optional<double> stop_ratio;
  bool exclude_events = false;
  bool as_one = false;           ///< the files are parts of one recording
  std::string sums;              ///< --sums: print the sums of one file; empty: analyse
  std::vector<double> starts_s;  ///< --starts: of the parts; empty: from their own clocks
  InputFlags input;
  OutputFlags output;
};

/// The verb. Throws Failure.
void run_noise(const NoiseCommand& command);

}  // namespace proofmass::app
