#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/acquire/framing.hpp"

namespace proofmass::acquire {

/// Who judges what a cutter finds, and is told of it in the order of the bytes.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// Whether bytes of a frame's length, without marks, have the checksum they should have.
  [[nodiscard]] virtual bool is_sound(std::string_view bytes) const = 0;
  virtual void frame(std::string_view bytes) = 0;
  /// Bytes that are in no frame; `frames` is how many may have been in them, and whether it was for
  /// a checksum.
  virtual void passed_over(std::size_t bytes, std::size_t frames, bool by_checksum) = 0;
};

/// Cuts a stream into frames of one length, and finds its way back after garbage.
class FrameCutter {
 public:
  virtual ~FrameCutter() = default;
  virtual void take(std::string_view bytes, FrameSink& sink) = 0;
  virtual void finish(FrameSink& sink) = 0;
};

/// Consistent overhead byte stuffing: no byte of a frame is 0.
/// Source: S. Cheshire, M. Baker, "Consistent overhead byte stuffing", IEEE/ACM Trans. Networking 7
/// (1999) 159, section III.
[[nodiscard]] std::unique_ptr<FrameCutter> cobs_cutter(std::size_t frame_bytes);
/// Source: RFC 1055.
[[nodiscard]] std::unique_ptr<FrameCutter> slip_cutter(std::size_t frame_bytes);
/// Frames behind a word. Without a checksum one is believed once the next word stands behind it.
[[nodiscard]] std::unique_ptr<FrameCutter> sync_cutter(std::string word,
                                                       std::size_t frame_bytes,
                                                       bool has_check);

}  // namespace proofmass::acquire
