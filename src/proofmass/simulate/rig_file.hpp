#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::simulate {

/// Reads a rig's description (TOML). A key that is absent keeps its default; [[segment]] and
/// [[sensor]] replace the default profile and the default pair. Angles in degrees, speeds in rpm.
/// Errors: unreadable, corrupt (no TOML), invalid_argument (an unknown key, a value of the wrong
/// kind or one that check() refuses; the message names file, line and key where there is one).
[[nodiscard]] Result<RigOptions> read_rig_file(const std::string& path);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Result<RigOptions> parse_rig_file(std::string_view text, std::string_view name);

/// A description that reads back as the same options, with a comment on every key.
[[nodiscard]] std::string format_rig_file(const RigOptions& options);

}  // namespace proofmass::simulate
