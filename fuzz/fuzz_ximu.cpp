// Packets with corrected checksums, so that their content is decoded: the input is kind and data of
// each packet, sent in the device's format; after a byte of ones, the rest is sent unchanged.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "check_reading.hpp"
#include "proofmass/io/ximu/specimens.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes = proofmass::io::specimen::ximu_date_time(1) +
                      proofmass::io::specimen::ximu_inertial({0, 0, 0, 0, 0, 2048, 0, 0, 0});
  constexpr std::uint8_t raw = 0xFF;  // the rest is sent unchanged
  std::size_t at = 0;
  while (at < size && data[at] != raw) {
    const std::uint8_t kind = data[at++] % 20;
    const std::size_t length = kind == 9 || kind == 8 ? 18 : (kind == 5 ? 6 : 4 * (kind % 3));
    std::vector<std::uint8_t> packet(data + at, data + std::min(size, at + length));
    at += packet.size();
    bytes += proofmass::io::specimen::ximu_packet(kind, packet);
  }
  bytes.append(reinterpret_cast<const char*>(data) + at, size - at);
  check_reading(std::as_bytes(std::span(bytes)));
  return 0;
}
