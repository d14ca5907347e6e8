#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <string>

#include "proofmass/io/recording_writers.hpp"

namespace proofmass::io {
namespace {

void append_little_endian(std::string& out, double value) {
  auto bytes = std::bit_cast<std::array<char, 8>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

}  // namespace

bool write_npy(const Recording& recording, const Sink& sink) {
  const bool timed = recording.time.source != TimeSource::none;
  std::string header =
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}",
                  recording.samples(), recording.channels.size() + (timed ? 1 : 0));
  // The figures begin at a multiple of 64 bytes, as the format asks, behind a line's end.
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() & 0xFF);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    if (timed) append_little_endian(out, recording.time.at(k));
    for (const Channel& channel : recording.channels) append_little_endian(out, channel.values[k]);
    if (out.size() < (1u << 16)) continue;
    if (!sink(out)) return false;
    out.clear();
  }
  return sink(out);
}

}  // namespace proofmass::io
