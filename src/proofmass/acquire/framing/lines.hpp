#pragma once

#include <memory>

#include "proofmass/acquire/framing/framing.hpp"

namespace proofmass::acquire {

/// Decoder of Framing::lines.
[[nodiscard]] Result<std::unique_ptr<Decoder>> make_line_decoder(const FramingOptions& options);

}  // namespace proofmass::acquire
