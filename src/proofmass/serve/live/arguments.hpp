#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proofmass/serve/folder.hpp"

namespace proofmass::serve {

/// A recorder that was asked for, as the arguments of the program.
struct LiveArguments {
  std::string source;
  std::string file;                      ///< of the recording; empty: samples are only shown
  std::string sensor_file, certificate;  ///< that a procedure ends with; empty without one
  std::vector<std::string> arguments;    ///< after the program's name
};

/// Checks {source, file, options}. `file` is a name within the folder that is not taken, "" for one
/// made of source and time, or null. options: rate, unit, estimate, radius, lag, axis, sensor,
/// duration; procedure, positions, target-std, minutes, as flags of `record`; a procedure needs a
/// file, beside which sensor file and certificate go.
/// Errors: invalid_argument (a source that leads out of the folder or is standard input, a name
/// that is taken or no name, another option), unreadable (no such sensor file).
[[nodiscard]] Result<LiveArguments> live_arguments(const nlohmann::json& asked,
                                                   const Folder& folder);

}  // namespace proofmass::serve
