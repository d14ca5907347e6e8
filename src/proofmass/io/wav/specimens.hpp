#pragma once

#include <cstdint>
#include <string>

#include "proofmass/io/matlab/mat_specimens.hpp"

// Writes WAV files, intact and damaged ones, for tests.
namespace proofmass::io::specimen {

/// A chunk, padded to an even length; `claimed` replaces its true length.
inline std::string chunk(const std::string& name,
                         const std::string& content,
                         Order order = Order::little,
                         std::int64_t claimed = -1) {
  const auto size = static_cast<std::uint32_t>(
      claimed >= 0 ? claimed : static_cast<std::int64_t>(content.size()));
  return name + bytes_of<std::uint32_t>({size}, order) + content +
         std::string(content.size() % 2, '\0');
}

struct WavFormat {
  std::uint16_t encoding = 1;  ///< 1 integers, 3 floating point
  std::uint16_t channels = 1;
  std::uint32_t rate_hz = 100;
  std::uint16_t bits = 16;
  Order order = Order::little;
};

inline std::string format_chunk(const WavFormat& f) {
  const auto row = static_cast<std::uint16_t>(f.channels * ((f.bits + 7) / 8));
  return chunk("fmt ",
               bytes_of<std::uint16_t>({f.encoding, f.channels}, f.order) +
                   bytes_of<std::uint32_t>({f.rate_hz, f.rate_hz * row}, f.order) +
                   bytes_of<std::uint16_t>({row, f.bits}, f.order),
               f.order);
}

/// A format with its encoding in an extended chunk.
inline std::string extensible_chunk(const WavFormat& f, std::uint16_t valid_bits) {
  const auto row = static_cast<std::uint16_t>(f.channels * ((f.bits + 7) / 8));
  return chunk("fmt ", bytes_of<std::uint16_t>({0xFFFE, f.channels}) +
                           bytes_of<std::uint32_t>({f.rate_hz, f.rate_hz * row}) +
                           bytes_of<std::uint16_t>({row, f.bits, 22, valid_bits}) +
                           bytes_of<std::uint32_t>({3}) + bytes_of<std::uint16_t>({f.encoding}) +
                           std::string("\0\0\0\0\x10\0\x80\0\0\xAA\0\x38\x9B\x71", 14));
}

inline std::string riff(const std::string& chunks, Order order = Order::little) {
  const auto size = static_cast<std::uint32_t>(chunks.size() + 4);
  return (order == Order::big ? "RIFX" : "RIFF") + bytes_of<std::uint32_t>({size}, order) + "WAVE" +
         chunks;
}

/// Samples in a file of the simplest kind.
inline std::string wav_file(const WavFormat& f, const std::string& samples) {
  return riff(format_chunk(f) + chunk("data", samples, f.order), f.order);
}

}  // namespace proofmass::io::specimen
