#pragma once

#include <string>

#include "proofmass/acquire/recorder/part_file.hpp"

namespace proofmass::acquire {

/// "run.0004.mcap" for "run.mcap", if the folder has numbers up to 3, closed or not: a number is
/// never reused.
[[nodiscard]] PartNames next_numbered(const std::string& path);

}  // namespace proofmass::acquire
