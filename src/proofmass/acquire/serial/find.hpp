#pragma once

#include <filesystem>
#include <vector>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Serial devices in `dev`, with the descriptions in `sys`.
[[nodiscard]] std::vector<FoundSource> serial_devices(const std::filesystem::path& dev,
                                                      const std::filesystem::path& sys);

}  // namespace proofmass::acquire
