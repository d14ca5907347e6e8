#include "proofmass/io/ximu/packets.hpp"

#include <chrono>
#include <numeric>

namespace proofmass::io::ximu {
namespace {

/// Packet length in bytes by type, header and checksum included; 0: a command of variable length.
constexpr std::array<std::uint8_t, headers> lengths{4,  0,  4, 8,  2,  8,  6,  6, 20,
                                                    20, 10, 4, 18, 18, 10, 26, 26};

std::optional<unsigned> from_bcd(std::uint8_t byte) {
  const unsigned tens = byte >> 4;
  const unsigned ones = byte & 15u;
  if (tens > 9 || ones > 9) return std::nullopt;
  return 10 * tens + ones;
}

}  // namespace

std::int16_t Packet::figure(std::size_t k) const {
  return static_cast<std::int16_t>(data[2 * k] << 8 | data[2 * k + 1]);
}

std::optional<std::int64_t> Packet::date_time_s() const {
  if (header != date_time_kind || data.size() != 6) return std::nullopt;
  std::array<unsigned, 6> part{};
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto figure = from_bcd(data[i]);
    if (!figure) return std::nullopt;
    part[i] = *figure;
  }
  const std::chrono::year_month_day date{std::chrono::year(2000 + static_cast<int>(part[0])),
                                         std::chrono::month(part[1]), std::chrono::day(part[2])};
  if (!date.ok() || part[3] > 23 || part[4] > 59 || part[5] > 59) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return days * 86'400 + part[3] * 3'600 + part[4] * 60 + part[5];
}

Decoder::Outcome Decoder::take(std::uint8_t byte) {
  if (taken_ < longest) sent_[taken_] = byte & 0x7Fu;
  if (taken_ <= longest) ++taken_;
  const bool ends = (byte & 0x80u) != 0;
  if (!ends) return Outcome::more;
  const std::size_t taken = taken_;
  taken_ = 0;
  return taken > longest ? Outcome::damaged : end_packet(taken);
}

Decoder::Outcome Decoder::end_packet(std::size_t taken) {
  const std::size_t length = taken * 7 / 8;
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t bit = 8 * i;
    const unsigned pair = sent_[bit / 7] << 7u | (bit / 7 + 1 < taken ? sent_[bit / 7 + 1] : 0u);
    bytes_[i] = static_cast<std::uint8_t>(pair >> (6 - bit % 7));
  }
  if (length < 2 || bytes_[0] >= headers) return Outcome::damaged;
  const std::size_t right_length = lengths[bytes_[0]];
  if (right_length != 0 && right_length != length) return Outcome::damaged;
  const unsigned sum =
      std::accumulate(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(length) - 1, 0u);
  if ((sum & 0xFFu) != bytes_[length - 1]) return Outcome::damaged;
  packet_ = {bytes_[0], std::span(bytes_).subspan(1, length - 2)};
  return Outcome::packet;
}

}  // namespace proofmass::io::ximu
