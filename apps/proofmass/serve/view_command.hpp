#pragma once

#include <string>
#include <string_view>

namespace proofmass::app {

/// What `serve` runs to look at a recording: `proofmass __view FILE FOLDER`.
inline constexpr std::string_view view_verb = "__view";

/// Lays a recording down in a folder for serve::ViewFile. Throws Failure.
void write_view(const std::string& file, const std::string& folder);

}  // namespace proofmass::app
