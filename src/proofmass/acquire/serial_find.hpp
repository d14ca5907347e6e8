#pragma once

#include <filesystem>
#include <vector>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Serial devices among those of `dev`, described by what `sys` says of them.
[[nodiscard]] std::vector<FoundSource> serial_devices(const std::filesystem::path& dev,
                                                      const std::filesystem::path& sys);

}  // namespace proofmass::acquire
