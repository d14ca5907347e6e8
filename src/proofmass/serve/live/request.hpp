#pragma once

#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/serve/live/frame.hpp"

namespace proofmass::serve {

inline constexpr std::size_t most_live_message_bytes = 4096;

/// A browser's message. Errors: invalid_argument (longer than most_live_message_bytes, not such an
/// object, something else in it).
[[nodiscard]] Result<LiveRequest> parse_live_request(std::string_view message);

}  // namespace proofmass::serve
