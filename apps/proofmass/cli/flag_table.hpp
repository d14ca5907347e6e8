#pragma once

#include <string>

namespace proofmass::app {

/// The verbs that read recordings and describe their result as a page, with their flags, as JSON
/// for a program that makes forms of them:
/// {"verbs": [{"name", "group", "help", "many_files", "series", "sensor_file",
///   "options": [{"name", "group", "help", "type", "choices", "default", "switch", "many", "file",
///   "required"}]}]}
/// Flags about the terminal and where results are written are left out.
[[nodiscard]] std::string flag_table();

}  // namespace proofmass::app
