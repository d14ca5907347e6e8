#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proofmass/serve/folder.hpp"

namespace proofmass::serve {

/// A run that was asked for, as the arguments of the program.
struct AnalysisArguments {
  std::string verb;
  std::vector<std::string> arguments;  ///< after the program's name
  bool writes_page = false;            ///< --page and --report
  bool writes_series = false;          ///< the verb has --output
  bool writes_sensor_file = false;     ///< --update-sensor was asked for
};

/// Checks {verb, files, options, sensor_file} against the table of verbs: what is not in it, a file
/// outside the folder, or a value of the wrong kind is refused. Values are glued to their flags, so
/// that none can be taken for a flag or a file.
/// Errors: invalid_argument, unreadable (no such file).
[[nodiscard]] Result<AnalysisArguments> analysis_arguments(const nlohmann::json& verbs,
                                                           const nlohmann::json& asked,
                                                           const Folder& folder);

/// A file's name, so that it cannot be taken for a flag.
[[nodiscard]] std::string plain_argument(const std::string& file);

/// The same as a person types it into a shell.
[[nodiscard]] std::string shell_command(const std::vector<std::string>& arguments);

}  // namespace proofmass::serve
