#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace proofmass::io::tdms {

/// Storage of a value of a TDMS channel.
enum class Kind : unsigned char {
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
  instant,  ///< Instant
  text,     ///< variable length
  other,    ///< unsupported: complex, extended, fixed point
};

/// 0 for text and other.
[[nodiscard]] std::size_t bytes_per_value(Kind kind);
/// Kind for the type code of a channel or a property.
[[nodiscard]] Kind kind_of(std::uint32_t type);
/// Kind for the type code of a DAQmx scaler; nullopt: unknown.
[[nodiscard]] std::optional<Kind> daqmx_kind(std::uint32_t type);
/// "complex numbers", "extended-precision numbers", … for a type of kind `other`.
[[nodiscard]] std::string words_for_type(std::uint32_t type);

/// Size of a value of a type of kind `other`; 0: unknown.
[[nodiscard]] std::size_t bytes_of_other(std::uint32_t type);

}  // namespace proofmass::io::tdms
