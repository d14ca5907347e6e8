#include "proofmass/io/mcap/put.hpp"

#include "proofmass/io/bytes/little_endian.hpp"

namespace proofmass::io::mcap {

void put_number(std::string& out, std::uint64_t value, std::size_t bytes) {
  append_little_endian(out, value, bytes);
}

void put_text(std::string& out, std::string_view text) {
  put_number(out, text.size(), 4);
  out += text;
}

void put_map(std::string& out, const Map& map) {
  std::string entries;
  for (const auto& [key, value] : map) {
    put_text(entries, key);
    put_text(entries, value);
  }
  put_text(out, entries);
}

void put_record_head(std::string& out, Op op, std::uint64_t bytes) {
  put_number(out, static_cast<std::uint64_t>(op), 1);
  put_number(out, bytes, 8);
}

std::string content_of(const Schema& schema) {
  std::string out;
  put_number(out, schema.id, 2);
  put_text(out, schema.name);
  put_text(out, schema.encoding);
  put_text(out, schema.data);
  return out;
}

std::string content_of(const ChannelRecord& channel) {
  std::string out;
  put_number(out, channel.id, 2);
  put_number(out, channel.schema, 2);
  put_text(out, channel.topic);
  put_text(out, channel.encoding);
  put_map(out, channel.metadata);
  return out;
}

}  // namespace proofmass::io::mcap
