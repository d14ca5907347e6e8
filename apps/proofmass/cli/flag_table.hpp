#pragma once

#include <string>

namespace proofmass::app {

/// The verbs that take a list of recordings and return a page, and the actions of `sensor`, with
/// flags, as JSON for programs that generate forms:
/// {"verbs": [{"name", "group", "help", "reads", "many_files", "page", "series", "sensor_file",
///   "options": [{"name", "group", "help", "type", "choices", "default", "switch", "many", "file",
///   "required"}]}]}
/// "reads" is "recordings" or "sensor_files"; without "page" the verb returns a document only.
/// Flags for the terminal and for output files are omitted.
[[nodiscard]] std::string flag_table();

}  // namespace proofmass::app
