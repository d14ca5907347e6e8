#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace proofmass::io {

/// A packet of x-io's x-IMU: a header that says what it is, big-endian figures, a checksum.
struct XimuPacket {
  std::uint8_t header = 0;
  std::span<const std::uint8_t> data;  ///< between header and checksum

  /// The 16-bit figure k of the data, with its sign.
  [[nodiscard]] std::int16_t figure(std::size_t k) const;
  /// Seconds since 1970 of a packet of date and time; nullopt if it is none, or an impossible one.
  [[nodiscard]] std::optional<std::int64_t> date_time_s() const;
};

inline constexpr std::uint8_t ximu_date_time_kind = 5;
inline constexpr std::uint8_t ximu_cal_inertial = 9;
inline constexpr std::size_t ximu_headers = 17;

/// Takes an x-IMU's bytes apart: seven bits of a packet in each, the highest bit set in its last.
/// Source: x-io Technologies, x-IMU User Manual 5.2, "Packet structure"; the figures of a file and
/// of the CSV that the maker's program wrote of it are the same.
class XimuDecoder {
 public:
  enum class Outcome { more, packet, damaged };

  /// Takes the next byte and says whether it ended a packet, or one that cannot be right: of an
  /// unknown kind, the wrong length or checksum.
  Outcome take(std::uint8_t byte);
  /// The packet that ended last; valid until the next byte.
  [[nodiscard]] const XimuPacket& packet() const { return packet_; }
  /// Whether bytes of a packet were taken that has not ended.
  [[nodiscard]] bool is_inside() const { return taken_ > 0; }

 private:
  static constexpr std::size_t longest = 30;  ///< bytes of the longest packet as it is sent

  Outcome end_packet(std::size_t taken);

  std::array<std::uint8_t, longest> sent_{};
  std::array<std::uint8_t, longest> bytes_{};
  std::size_t taken_ = 0;
  XimuPacket packet_;
};

}  // namespace proofmass::io
