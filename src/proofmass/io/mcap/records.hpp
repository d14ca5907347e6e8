#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace proofmass::io::mcap {

/// Record types of an MCAP file. Source: MCAP format specification, "Records".
enum class Op : unsigned char {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t record_head_bytes = 9;  ///< bytes: opcode and length
inline constexpr std::size_t footer_bytes = 20;      ///< without its header

using Map = std::map<std::string, std::string>;

struct Schema {
  std::uint16_t id = 0;
  std::string name;
  std::string encoding;
  std::string data;
};

struct ChannelRecord {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic;
  std::string encoding;
  Map metadata;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_ns = 0;
  std::uint64_t publish_ns = 0;
  std::string_view data;
};

/// A chunk's record up to its data.
struct ChunkHead {
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = 0;
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t crc = 0;  ///< checksum of the decompressed bytes; 0: none
  std::string compression;
  std::uint64_t packed_bytes = 0;
  std::size_t head_bytes = 0;  ///< size of the record's content before the compressed bytes
};

struct Metadata {
  std::string name;
  Map values;
};

/// An attachment's record up to its data.
struct AttachmentHead {
  std::uint64_t log_ns = 0;
  std::uint64_t create_ns = 0;  ///< 0: unknown
  std::string name;
  std::string media_type;
  std::uint64_t bytes = 0;
  std::size_t head_bytes = 0;  ///< size of the record's content before the attachment's
};

struct Footer {
  std::uint64_t summary_start = 0;  ///< 0: none
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  ///< 0: none
};

struct Statistics {
  std::uint64_t messages = 0;
  std::map<std::uint16_t, std::uint64_t> of_channels;  ///< messages
};

/// Reads numbers and texts, little-endian, from the beginning of bytes that may be too few: after
/// the first missing one everything is zero or empty, and is_whole() false.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::string_view text() { return take(u32()); }  ///< preceded by its length
  std::string_view take(std::uint64_t count);
  Map map();
  [[nodiscard]] bool is_whole() const { return is_whole_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::uint64_t number(std::size_t count);

  std::string_view bytes_;
  bool is_whole_ = true;
};

/// Parses the content of a record; nullopt if it is truncated. Bytes after the last field are
/// ignored, because later versions may add some.
[[nodiscard]] std::optional<Schema> parse_schema(std::string_view content);
[[nodiscard]] std::optional<ChannelRecord> parse_channel(std::string_view content);
[[nodiscard]] std::optional<Message> parse_message(std::string_view content);
[[nodiscard]] std::optional<ChunkHead> parse_chunk_head(std::string_view content);
[[nodiscard]] std::optional<Metadata> parse_metadata(std::string_view content);
[[nodiscard]] std::optional<AttachmentHead> parse_attachment_head(std::string_view content);
/// The attachment itself; nullopt if it is truncated or its checksum is wrong.
[[nodiscard]] std::optional<std::string_view> attachment_data(std::string_view content,
                                                              const AttachmentHead& head);
[[nodiscard]] std::optional<Footer> parse_footer(std::string_view content);
[[nodiscard]] std::optional<Statistics> parse_statistics(std::string_view content);

/// "a chunk", "a message"; "a record of kind 0x85" if unknown.
[[nodiscard]] std::string record_name(Op op);

}  // namespace proofmass::io::mcap
