#pragma once

#include <cstdint>

#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// The origin of stamps in seconds, shifted by `by_ns` nanoseconds without loss of digits;
/// unchanged if its values are implausible.
[[nodiscard]] StampOrigin moved(const StampOrigin& origin, std::int64_t by_ns);

}  // namespace proofmass::io
