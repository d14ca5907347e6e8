#include "proofmass/io/mcap/put.hpp"

#include "proofmass/io/bytes/little_endian.hpp"

namespace proofmass::io {

void put_number(std::string& out, std::uint64_t value, std::size_t bytes) {
  append_little_endian(out, value, bytes);
}

void put_mcap_text(std::string& out, std::string_view text) {
  put_number(out, text.size(), 4);
  out += text;
}

void put_mcap_map(std::string& out, const McapMap& map) {
  std::string entries;
  for (const auto& [key, value] : map) {
    put_mcap_text(entries, key);
    put_mcap_text(entries, value);
  }
  put_mcap_text(out, entries);
}

void put_record_head(std::string& out, McapOp op, std::uint64_t bytes) {
  put_number(out, static_cast<std::uint64_t>(op), 1);
  put_number(out, bytes, 8);
}

std::string content_of(const McapSchema& schema) {
  std::string out;
  put_number(out, schema.id, 2);
  put_mcap_text(out, schema.name);
  put_mcap_text(out, schema.encoding);
  put_mcap_text(out, schema.data);
  return out;
}

std::string content_of(const McapChannel& channel) {
  std::string out;
  put_number(out, channel.id, 2);
  put_number(out, channel.schema, 2);
  put_mcap_text(out, channel.topic);
  put_mcap_text(out, channel.encoding);
  put_mcap_map(out, channel.metadata);
  return out;
}

}  // namespace proofmass::io
