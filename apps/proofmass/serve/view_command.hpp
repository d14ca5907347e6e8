#pragma once

#include <string>
#include <string_view>

namespace proofmass::app {

/// The command that `serve` runs to display a recording: `proofmass __view FILE FOLDER`.
inline constexpr std::string_view view_verb = "__view";

/// Prepares a folder for serve::ViewFile from a recording. Throws Failure.
void write_view(const std::string& file, const std::string& folder);

}  // namespace proofmass::app
