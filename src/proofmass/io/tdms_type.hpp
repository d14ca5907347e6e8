#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace proofmass::io {

/// How a value of a TDMS channel is stored.
enum class TdmsKind : unsigned char {
  i8,
  i16,
  i32,
  i64,
  u8,
  u16,
  u32,
  u64,
  f32,
  f64,
  boolean,
  instant,  ///< TdmsInstant
  text,     ///< of any length
  other,    ///< not read: complex, extended, fixed point
};

/// 0 for text and other.
[[nodiscard]] std::size_t bytes_of(TdmsKind kind);
/// Of a type as a channel or a property names it.
[[nodiscard]] TdmsKind tdms_kind(std::uint32_t type);
/// Of a type as a DAQmx scaler names it; nullopt: not known.
[[nodiscard]] std::optional<TdmsKind> daqmx_kind(std::uint32_t type);
/// "complex numbers", "extended-precision numbers", … of a type whose kind is `other`.
[[nodiscard]] std::string words_for_type(std::uint32_t type);

/// Bytes of a value of a type whose kind is `other`; 0: not known.
[[nodiscard]] std::size_t bytes_of_other(std::uint32_t type);

}  // namespace proofmass::io
