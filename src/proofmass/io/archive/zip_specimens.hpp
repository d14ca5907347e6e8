#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
#include <zlib.h>

#include "proofmass/io/bytes/deflate_test_support.hpp"

namespace proofmass::io::specimen {

/// A file of a hand-made zip archive, and its faults.
struct ZipFile {
  std::string name;
  std::string text;
  bool deflate = false;
  std::uint16_t flags = 0;  ///< 1: encrypted
  int method = -1;          ///< if it differs from the actual one
  bool wrong_checksum = false;
  std::uint32_t claimed_more = 0;  ///< bytes in the directory beyond those present
};

inline std::string little(std::uint32_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xFFu));
  return out;
}

/// Source: PKWARE, APPNOTE 6.3.9, 4.3.6 "Overall .ZIP file format".
inline std::string zip(const std::vector<ZipFile>& files) {
  std::string out;
  std::string directory;
  for (const ZipFile& file : files) {
    constexpr int raw_deflate = -MAX_WBITS;
    const std::string packed = file.deflate ? deflated(file.text, raw_deflate) : file.text;
    const auto checksum =
        static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(file.text.data()),
                                         static_cast<uInt>(file.text.size())) ^
                                   (file.wrong_checksum ? 1u : 0u));
    const auto method =
        static_cast<std::uint32_t>(file.method >= 0 ? file.method : (file.deflate ? 8 : 0));
    const std::string shared =
        little(20, 2) + little(file.flags, 2) + little(method, 2) + little(0, 2) + little(0x21, 2) +
        little(checksum, 4) + little(static_cast<std::uint32_t>(packed.size()), 4) +
        little(static_cast<std::uint32_t>(file.text.size()) + file.claimed_more, 4) +
        little(static_cast<std::uint32_t>(file.name.size()), 2) + little(0, 2);
    directory += "PK\x01\x02" + little(20, 2) + shared + little(0, 2) + little(0, 2) +
                 little(0, 2) + little(0, 4) + little(static_cast<std::uint32_t>(out.size()), 4) +
                 file.name;
    out += "PK\x03\x04" + shared + file.name + packed;
  }
  const auto count = static_cast<std::uint32_t>(files.size());
  return out + directory + "PK\x05\x06" + little(0, 4) + little(count, 2) + little(count, 2) +
         little(static_cast<std::uint32_t>(directory.size()), 4) +
         little(static_cast<std::uint32_t>(out.size()), 4) + little(0, 2);
}

/// A table "t (s)" and three axes, at 100 Hz, in g.
inline std::string table_of(std::size_t rows, const std::string& sensor = "acc") {
  std::string text = "t (s)," + sensor + " x (g)," + sensor + " y (g)," + sensor + " z (g)\n";
  for (std::size_t k = 0; k < rows; ++k)
    text +=
        std::to_string(static_cast<double>(k) * 0.01) + "," + std::to_string(k % 7) + ",0.5,1\n";
  return text;
}

}  // namespace proofmass::io::specimen
