#pragma once

#include <string>
#include <vector>

namespace proofmass::app {

/// One flag from a configuration file.
struct ConfigEntry {
  std::string verb;                 ///< the table it stands in; empty: for every verb
  std::string flag;                 ///< "spin-axis", without dashes in front; "_" is read as "-"
  std::vector<std::string> values;  ///< as on a command line; of a switch "true" or "false"
  std::size_t line = 0;
};

/// Reads a TOML file: `flag = value` at its top holds for every verb that has the flag, in a table
/// `[wheel]` for that verb. Throws Failure.
[[nodiscard]] std::vector<ConfigEntry> read_config(const std::string& path);

}  // namespace proofmass::app
