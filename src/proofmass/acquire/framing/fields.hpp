#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/acquire/framing/checks.hpp"
#include "proofmass/acquire/framing/clock.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// A field of a frame with fixed layout.
struct FrameField {
  enum class Kind { whole_unsigned, whole_signed, floating };
  std::string name{};
  Kind kind = Kind::whole_unsigned;
  std::size_t offset = 0, bytes = 1;
  bool big_endian = false;
};

/// "u32 t_us, i16 x y z, u8 seq, pad 1, crc16": the position of each field, without gaps.
struct FrameLayout {
  std::vector<FrameField> fields{};
  std::size_t bytes = 0;
  std::optional<Check> check{};
  std::size_t check_offset = 0;
  bool check_big_endian = false;

  /// Comma-separated groups: be or le (for the group), a type, names. Types: u8 i8 u16 i16 u24 i24
  /// u32 i32 u64 i64 f32 f64, pad (with a number of bytes), crc8 crc16 crc16-modbus crc32.
  /// Errors: invalid_argument.
  [[nodiscard]] static Result<FrameLayout> parse(std::string_view text, bool big_endian);
  /// Expects frame.size() == bytes.
  [[nodiscard]] bool is_sound(std::string_view frame) const;
  /// The values of all fields. Expects frame.size() == bytes, and one value per field.
  void read(std::string_view frame, std::span<double> values) const;
};

/// A field as a clock value, exact for an integer; nullopt if it is not a number.
[[nodiscard]] std::optional<Tick> read_tick(std::string_view frame, const FrameField& field);

}  // namespace proofmass::acquire
