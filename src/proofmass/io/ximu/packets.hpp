#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace proofmass::io::ximu {

/// A packet of x-io's x-IMU: a header with its type, big-endian numbers, a checksum.
struct Packet {
  std::uint8_t header = 0;
  std::span<const std::uint8_t> data;  ///< between header and checksum

  /// The signed 16-bit number k of the data.
  [[nodiscard]] std::int16_t figure(std::size_t k) const;
  /// Seconds since 1970 for a packet of date and time; nullopt for other packets, or an impossible
  /// time.
  [[nodiscard]] std::optional<std::int64_t> date_time_s() const;
};

inline constexpr std::uint8_t date_time_kind = 5;
inline constexpr std::uint8_t cal_inertial = 9;
inline constexpr std::size_t headers = 17;

/// Decodes an x-IMU's bytes: each contains seven bits of a packet, and the highest bit is set in
/// its last.
/// Source: x-io Technologies, x-IMU User Manual 5.2, "Packet structure"; the numbers of a file and
/// of the CSV that the manufacturer's program wrote from it are the same.
class Decoder {
 public:
  enum class Outcome { more, packet, damaged };

  /// Takes the next byte; returns whether it ended a packet, or an invalid one: of an unknown type,
  /// or with a wrong length or checksum.
  Outcome take(std::uint8_t byte);
  /// The last complete packet; valid until the next byte.
  [[nodiscard]] const Packet& packet() const { return packet_; }
  /// True if part of a packet was taken.
  [[nodiscard]] bool is_inside() const { return taken_ > 0; }

 private:
  static constexpr std::size_t longest = 30;  ///< bytes of the longest packet as transmitted

  Outcome end_packet(std::size_t taken);

  std::array<std::uint8_t, longest> sent_{};
  std::array<std::uint8_t, longest> bytes_{};
  std::size_t taken_ = 0;
  Packet packet_;
};

}  // namespace proofmass::io::ximu
