#pragma once

#include <string_view>

namespace proofmass {

/// Version of this build, "0.1.0": the first entry of every document.
[[nodiscard]] std::string_view version();

}  // namespace proofmass
