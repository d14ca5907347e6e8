#pragma once

#include <memory>

#include "proofmass/acquire/framing/framing.hpp"

namespace proofmass::acquire {

/// Decoder of all other framings. Errors: invalid_argument (fields=, scale=, …).
[[nodiscard]] Result<std::unique_ptr<Decoder>> make_frame_decoder(const FramingOptions& options);

}  // namespace proofmass::acquire
