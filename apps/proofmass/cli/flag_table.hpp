#pragma once

#include <string>

namespace proofmass::app {

/// The verbs that read recordings and return a page, with their flags, as JSON for programs that
/// generate forms:
/// {"verbs": [{"name", "group", "help", "many_files", "series", "sensor_file",
///   "options": [{"name", "group", "help", "type", "choices", "default", "switch", "many", "file",
///   "required"}]}]}
/// Flags for the terminal and for output files are omitted.
[[nodiscard]] std::string flag_table();

}  // namespace proofmass::app
