#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"

namespace proofmass::app {

/// The thesis's programme on given recordings; the rest is simulated.
struct ThesisCommand {
  std::string still, tumble;        ///< --static, --tumble: files; empty: simulated
  std::vector<std::string> wheels;  ///< --wheel: one run for each speed; empty: simulated
  std::vector<double> angles_deg;   ///< --angles: of the rests in `tumble`
  std::optional<double> radius_m;
  std::size_t runs = 50;      ///< simulated runs at each speed
  double static_hours = 2.0;  ///< duration of the simulated static test
  std::uint64_t seed = 1;
  InputFlags input;
  OutputFlags output;
};

}  // namespace proofmass::app
