#pragma once

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace proofmass::io::specimen {

/// A packet of an x-IMU as transmitted: header, data and checksum in groups of seven bits.
inline std::string ximu_packet(std::uint8_t header,
                               const std::vector<std::uint8_t>& data,
                               std::uint8_t add_to_checksum = 0) {
  std::vector<std::uint8_t> bytes{header};
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.push_back(static_cast<std::uint8_t>(
      std::accumulate(bytes.begin(), bytes.end(), unsigned{add_to_checksum})));
  std::string bits;
  for (const std::uint8_t byte : bytes)
    for (int bit = 7; bit >= 0; --bit) bits.push_back((byte >> bit & 1) != 0 ? '1' : '0');
  while (bits.size() % 7 != 0) bits.push_back('0');
  std::string sent;
  for (std::size_t i = 0; i < bits.size(); i += 7)
    sent.push_back(static_cast<char>(std::stoi(bits.substr(i, 7), nullptr, 2)));
  sent.back() = static_cast<char>(sent.back() | '\x80');
  return sent;
}

/// Nine figures: gyroscope, accelerometer, magnetometer.
inline std::string ximu_inertial(const std::vector<std::int16_t>& figures) {
  std::vector<std::uint8_t> data;
  for (const std::int16_t figure : figures) {
    data.push_back(static_cast<std::uint8_t>(static_cast<std::uint16_t>(figure) >> 8));
    data.push_back(static_cast<std::uint8_t>(figure & 0xFF));
  }
  return ximu_packet(9, data);
}

/// 2000-01-01 10:20 plus `second`, less than a minute.
inline std::string ximu_date_time(int second) {
  const auto bcd = static_cast<std::uint8_t>(second / 10 * 16 + second % 10);
  return ximu_packet(5, {0x00, 0x01, 0x01, 0x10, 0x20, bcd});
}

}  // namespace proofmass::io::specimen
