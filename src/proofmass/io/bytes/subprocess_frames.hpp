#pragma once

#include <cstdint>

namespace proofmass::io {

// Kinds of frames in a message from a child.

enum class FrameKind : std::uint32_t { data = 0x61746164, error = 0x6F727265, end = 0x20646E65 };

struct FrameHeader {
  FrameKind kind = FrameKind::end;
  std::uint32_t bytes = 0;
};

}  // namespace proofmass::io
