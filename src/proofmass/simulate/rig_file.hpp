#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::simulate {

/// Reads a rig's description (TOML). An absent key has its default; [[segment]] and [[sensor]]
/// replace the default profile and the default pair. Angles in degrees, speeds in rpm.
/// Errors: unreadable, corrupt (not TOML), invalid_argument (an unknown key, a value of the wrong
/// type or rejected by check(); the message names file, line and key if there is one).
[[nodiscard]] Result<RigOptions> read_rig_file(const std::string& path);

/// The same from text; `name` is the file name in messages.
[[nodiscard]] Result<RigOptions> parse_rig_file(std::string_view text, std::string_view name);

/// A description that parses to the same options, with a comment on every key.
[[nodiscard]] std::string format_rig_file(const RigOptions& options);

}  // namespace proofmass::simulate
