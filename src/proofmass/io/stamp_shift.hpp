#pragma once

#include <cstdint>

#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// The origin of stamps in seconds, later by so many nanoseconds, and no digit less exact; as it
/// is where its figures are beyond all sense.
[[nodiscard]] StampOrigin moved(const StampOrigin& origin, std::int64_t by_ns);

}  // namespace proofmass::io
