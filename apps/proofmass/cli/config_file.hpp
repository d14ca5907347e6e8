#pragma once

#include <string>
#include <vector>

namespace proofmass::app {

/// One flag from a configuration file.
struct ConfigEntry {
  std::string verb;                 ///< its table; empty: for every verb
  std::string flag;                 ///< "spin-axis", without leading dashes; "_" is equivalent to
                                    ///< "-"
  std::vector<std::string> values;  ///< command-line arguments; for a switch "true" or "false"
  std::size_t line = 0;
};

/// Reads a TOML file: `flag = value` at top level applies to every verb with that flag, in a table
/// `[wheel]` to that verb. Throws Failure.
[[nodiscard]] std::vector<ConfigEntry> read_config(const std::string& path);

}  // namespace proofmass::app
