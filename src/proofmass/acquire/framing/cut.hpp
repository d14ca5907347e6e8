#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/acquire/framing/framing.hpp"

namespace proofmass::acquire {

/// Receives the frames found by a cutter, in the order of the bytes, and validates them.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// True if bytes of a frame's length, without delimiters, have a valid checksum.
  [[nodiscard]] virtual bool is_sound(std::string_view bytes) const = 0;
  virtual void frame(std::string_view bytes) = 0;
  /// Skipped bytes outside any frame; `frames` is the number of frames they may have contained,
  /// by_checksum whether a checksum failed.
  virtual void skipped(std::size_t bytes, std::size_t frames, bool by_checksum) = 0;
};

/// Splits a stream into frames of fixed length, and resynchronises after garbage.
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
/// Frames after a sync word. Without a checksum a frame is accepted once the next sync word follows
/// it.
[[nodiscard]] std::unique_ptr<FrameCutter> sync_cutter(std::string word,
                                                       std::size_t frame_bytes,
                                                       bool has_check);

}  // namespace proofmass::acquire
