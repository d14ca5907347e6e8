#include "proofmass/io/mcap/records.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/io/bytes/crc32.hpp"

namespace proofmass::io::mcap {

std::string_view Fields::take(std::uint64_t count) {
  if (count > bytes_.size()) {
    is_whole_ = false;
    bytes_ = {};
    return {};
  }
  const std::string_view taken = bytes_.substr(0, count);
  bytes_.remove_prefix(count);
  return taken;
}

std::uint64_t Fields::number(std::size_t count) {
  const std::string_view taken = take(count);
  std::uint64_t value = 0;
  for (std::size_t i = taken.size(); i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(taken[i]);
  return value;
}

Map Fields::map() {
  Fields entries(text());
  Map out;
  while (entries.left() > 0) {
    const std::string_view key = entries.text();
    const std::string_view value = entries.text();
    if (!entries.is_whole()) {
      is_whole_ = false;
      break;
    }
    out.emplace(key, value);
  }
  return out;
}

namespace {

template <class T>
std::optional<T> if_whole(const Fields& fields, T value) {
  return fields.is_whole() ? std::optional<T>(std::move(value)) : std::nullopt;
}

}  // namespace

std::optional<Schema> parse_schema(std::string_view content) {
  Fields fields(content);
  Schema out;
  out.id = fields.u16();
  out.name = fields.text();
  out.encoding = fields.text();
  out.data = fields.text();
  return if_whole(fields, std::move(out));
}

std::optional<ChannelRecord> parse_channel(std::string_view content) {
  Fields fields(content);
  ChannelRecord out;
  out.id = fields.u16();
  out.schema = fields.u16();
  out.topic = fields.text();
  out.encoding = fields.text();
  out.metadata = fields.map();
  return if_whole(fields, std::move(out));
}

std::optional<Message> parse_message(std::string_view content) {
  Fields fields(content);
  Message out;
  out.channel = fields.u16();
  out.sequence = fields.u32();
  out.log_ns = fields.u64();
  out.publish_ns = fields.u64();
  out.data = fields.take(fields.left());
  return if_whole(fields, out);
}

std::optional<ChunkHead> parse_chunk_head(std::string_view content) {
  Fields fields(content);
  ChunkHead out;
  out.start_ns = fields.u64();
  out.end_ns = fields.u64();
  out.unpacked_bytes = fields.u64();
  out.crc = fields.u32();
  out.compression = fields.text();
  out.packed_bytes = fields.u64();
  out.head_bytes = content.size() - fields.left();
  return if_whole(fields, std::move(out));
}

std::optional<Metadata> parse_metadata(std::string_view content) {
  Fields fields(content);
  Metadata out;
  out.name = fields.text();
  out.values = fields.map();
  return if_whole(fields, std::move(out));
}

std::optional<AttachmentHead> parse_attachment_head(std::string_view content) {
  Fields fields(content);
  AttachmentHead out;
  out.log_ns = fields.u64();
  out.create_ns = fields.u64();
  out.name = fields.text();
  out.media_type = fields.text();
  out.bytes = fields.u64();
  out.head_bytes = content.size() - fields.left();
  return if_whole(fields, std::move(out));
}

std::optional<std::string_view> attachment_data(std::string_view content,
                                                const AttachmentHead& head) {
  Fields fields(content.substr(head.head_bytes));
  const std::string_view data = fields.take(head.bytes);
  const std::uint32_t crc = fields.u32();
  const std::string_view checked = content.substr(0, head.head_bytes + data.size());
  const bool is_damaged = !fields.is_whole() || (crc != 0 && crc32(0, checked) != crc);
  return is_damaged ? std::nullopt : std::optional(data);
}

std::optional<Footer> parse_footer(std::string_view content) {
  Fields fields(content);
  Footer out;
  out.summary_start = fields.u64();
  out.summary_offset_start = fields.u64();
  out.summary_crc = fields.u32();
  return if_whole(fields, out);
}

std::optional<Statistics> parse_statistics(std::string_view content) {
  Fields fields(content);
  Statistics out;
  out.messages = fields.u64();
  fields.take(2 + 4 + 4 + 4 + 4 + 8 + 8);
  Fields counts(fields.text());
  while (counts.left() > 0 && counts.is_whole()) {
    const std::uint16_t channel = counts.u16();
    out.of_channels[channel] = counts.u64();
  }
  if (!counts.is_whole()) return std::nullopt;
  return if_whole(fields, std::move(out));
}

std::string record_name(Op op) {
  constexpr std::array<std::string_view, 16> names{
      "",
      "the header",
      "the footer",
      "a schema",
      "a channel",
      "a message",
      "a chunk",
      "a message index",
      "a chunk index",
      "an attachment",
      "an attachment index",
      "the statistics",
      "metadata",
      "a metadata index",
      "a summary offset",
      "the end of the data",
  };
  const auto number = static_cast<std::size_t>(op);
  if (number > 0 && number < names.size()) return std::string(names[number]);
  return fmt::format("a record of kind 0x{:02x}", number);
}

}  // namespace proofmass::io::mcap
