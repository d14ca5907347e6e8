#pragma once

#include <cstdint>
#include <lz4frame.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include <zlib.h>
#include <zstd.h>

// Writes MCAP files, intact and damaged ones, for tests: independently, so that the reader is not
// tested against the writer alone.
namespace proofmass::io::specimen {

inline std::string le(std::uint64_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i)
    out += i < sizeof(value) ? static_cast<char>(value >> (8 * i) & 0xFF) : '\0';
  return out;
}

inline std::string mcap_text(std::string_view text) {
  return le(text.size(), 4) + std::string(text);
}

inline std::string mcap_record(int op, const std::string& content) {
  return le(static_cast<std::uint64_t>(op), 1) + le(content.size(), 8) + content;
}

inline std::string mcap_front(std::string_view profile = "") {
  return std::string("\x89MCAP0\r\n", 8) + mcap_record(1, mcap_text(profile) + mcap_text("a test"));
}

inline std::string mcap_schema_record(int id,
                                      std::string_view name,
                                      std::string_view encoding,
                                      std::string_view data) {
  return mcap_record(3, le(static_cast<std::uint64_t>(id), 2) + mcap_text(name) +
                            mcap_text(encoding) + mcap_text(data));
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

inline std::string mcap_pairs(const Pairs& pairs) {
  std::string entries;
  for (const auto& [key, value] : pairs) entries += mcap_text(key) + mcap_text(value);
  return mcap_text(entries);
}

inline std::string mcap_channel_record(int id,
                                       int schema,
                                       std::string_view topic,
                                       std::string_view encoding,
                                       const Pairs& metadata = {}) {
  return mcap_record(4, le(static_cast<std::uint64_t>(id), 2) +
                            le(static_cast<std::uint64_t>(schema), 2) + mcap_text(topic) +
                            mcap_text(encoding) + mcap_pairs(metadata));
}

inline std::string mcap_message_record(int channel, std::uint64_t log_ns, const std::string& data) {
  return mcap_record(5, le(static_cast<std::uint64_t>(channel), 2) + le(0, 4) + le(log_ns, 8) +
                            le(log_ns, 8) + data);
}

inline std::uint32_t zlib_crc(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

inline std::string packed(const std::string& bytes, std::string_view compression) {
  std::string out;
  if (compression == "zstd") {
    out.resize(ZSTD_compressBound(bytes.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  } else if (compression == "lz4") {
    out.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  } else {
    out = bytes;
  }
  return out;
}

/// Claims in a chunk header, to make them wrong.
struct ChunkClaims {
  std::string compression{};
  std::uint64_t unpacked_bytes = ~std::uint64_t{0};
  std::uint32_t crc = 1;  ///< 1: the correct one
};

inline std::string mcap_chunk(const std::string& records, const ChunkClaims& claims = {}) {
  const std::string bytes = packed(records, claims.compression);
  const std::uint64_t size =
      claims.unpacked_bytes == ~std::uint64_t{0} ? records.size() : claims.unpacked_bytes;
  const std::uint32_t crc = claims.crc == 1 ? zlib_crc(records) : claims.crc;
  return mcap_record(6, le(5'000'000'000, 8) + le(6'000'000'000, 8) + le(size, 8) + le(crc, 4) +
                            mcap_text(claims.compression) + le(bytes.size(), 8) + bytes);
}

/// The end of the data without a summary.
inline std::string mcap_end(std::uint32_t data_crc = 0) {
  return mcap_record(15, le(data_crc, 4)) + mcap_record(2, std::string(20, '\0')) +
         std::string("\x89MCAP0\r\n", 8);
}

/// The end of the data with a summary that counts messages and lists chunks: `before` is everything
/// preceding it.
inline std::string mcap_end_with_summary(const std::string& before,
                                         const std::vector<std::pair<int, std::uint64_t>>& messages,
                                         const std::vector<std::uint64_t>& chunk_starts = {}) {
  std::string counts;
  std::uint64_t sum = 0;
  for (const auto& [channel, count] : messages) sum += count;
  for (const auto& [channel, count] : messages)
    counts += le(static_cast<std::uint64_t>(channel), 2) + le(count, 8);
  std::string summary;
  for (const std::uint64_t start : chunk_starts)
    summary += mcap_record(
        8, le(0, 16) + le(start, 8) + le(0, 8) + le(0, 4) + le(0, 8) + le(0, 4) + le(0, 16));
  summary += mcap_record(11, le(sum, 8) + le(0, 2) + le(1, 4) + le(0, 4) + le(0, 4) + le(0, 4) +
                                 le(0, 16) + mcap_text(counts));
  const std::string data_end = mcap_record(15, le(zlib_crc(before), 4));
  std::string checked =
      summary + le(2, 1) + le(20, 8) + le(before.size() + data_end.size(), 8) + le(0, 8);
  return data_end + checked + le(zlib_crc(checked), 4) + std::string("\x89MCAP0\r\n", 8);
}

/// A JSON channel 1 on topic "/acc".
inline std::string json_channel() {
  return mcap_channel_record(1, 0, "/acc", "json");
}

/// A message on it, at 100 Hz.
inline std::string json_message(int k) {
  return mcap_message_record(1, 1'700'000'000'000'000'000 + 10'000'000 * std::uint64_t(k),
                             "{\"ax\": " + std::to_string(k) + ", \"ay\": 0.5, \"az\": 9.81}");
}

inline std::string json_messages(int first, int count) {
  std::string out;
  for (int k = first; k < first + count; ++k) out += json_message(k);
  return out;
}

}  // namespace proofmass::io::specimen
