#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"

namespace proofmass::app {

struct TumbleCommand {
  std::vector<std::string> files;
  std::string rests;               ///< --rests: list of intervals
  std::vector<double> angles_deg;  ///< --angles: one per rest of a recording, in order
  std::optional<double> shortest_rest_s;
  std::string angle_channel;        ///< --angle: the column with the angle; empty: by its name
  std::string input_axis;           ///< --input-axis: channel of the axis at g sin(angle)
  std::vector<int> planes, mounts;  ///< --plane, --mount: one per file; empty: from columns, or 1
                                    ///< and 0
  /// --indexing-std, --drift-std, --bandwidth; absent: assumed, or estimated from the residuals
  std::optional<double> indexing_std_deg, drift_std_mps2, bandwidth_hz;
  std::optional<double> gravity_std_mps2;
  bool rotating = false;                  ///< --rotating: run_rotation()
  std::vector<std::string> coefficients;  ///< --coefficients: run_model_equation()
  std::string update_sensor;
  InputFlags input;
  OutputFlags output;
};

/// The verb. Throws Failure.
void run_tumble(const TumbleCommand& command);

}  // namespace proofmass::app
