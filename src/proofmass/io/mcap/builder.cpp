#include "proofmass/io/mcap/builder.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/bytes/crc32.hpp"
#include "proofmass/io/mcap/put.hpp"

namespace proofmass::io {
McapBuilder::McapBuilder(const std::string& library,
                         McapChunking chunking,
                         const std::string& profile)
    : chunking_(chunking), bytes_(mcap_magic) {
  std::string content;
  put_mcap_text(content, profile);
  put_mcap_text(content, library);
  record(bytes_, McapOp::header, content);
}

void McapBuilder::record(std::string& out, McapOp op, std::string_view content) {
  put_record_head(out, op, content.size());
  out += content;
}

std::uint16_t McapBuilder::add_schema(McapSchema schema) {
  PM_EXPECTS(schemas_.size() < 0xFFFF);
  schema.id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back(std::move(schema));
  return schemas_.back().id;
}

std::uint16_t McapBuilder::add_channel(McapChannel channel) {
  PM_EXPECTS(channels_.size() < 0xFFFF);
  channel.id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back(std::move(channel));
  sequences_.push_back(0);
  return channels_.back().id;
}

void McapBuilder::put_definitions() {
  for (; schemas_put_ < schemas_.size(); ++schemas_put_)
    record(chunk_, McapOp::schema, content_of(schemas_[schemas_put_]));
  for (; channels_put_ < channels_.size(); ++channels_put_)
    record(chunk_, McapOp::channel, content_of(channels_[channels_put_]));
}

void McapBuilder::add_message(std::uint16_t channel, std::uint64_t log_ns, std::string_view data) {
  PM_EXPECTS(channel > 0 && channel <= channels_.size());
  add_message({channel, sequences_[channel - 1u], log_ns, log_ns, data});
}

void McapBuilder::add_message(const McapMessage& message) {
  PM_EXPECTS(message.channel > 0 && message.channel <= channels_.size());
  if (chunking_.is_self_contained && chunk_.empty()) schemas_put_ = channels_put_ = 0;
  put_definitions();
  const std::uint64_t log_ns = message.log_ns;
  const bool is_first = chunk_entries_.empty();
  chunk_start_ns_ = is_first ? log_ns : std::min(chunk_start_ns_, log_ns);
  chunk_end_ns_ = is_first ? log_ns : std::max(chunk_end_ns_, log_ns);
  chunk_entries_[message.channel].push_back({log_ns, chunk_.size()});
  put_record_head(chunk_, McapOp::message, 2 + 4 + 8 + 8 + message.data.size());
  put_number(chunk_, message.channel, 2);
  put_number(chunk_, message.sequence, 4);
  put_number(chunk_, log_ns, 8);
  put_number(chunk_, message.publish_ns, 8);
  chunk_ += message.data;
  ++sequences_[message.channel - 1u];
  start_ns_ = messages_ == 0 ? log_ns : std::min(start_ns_, log_ns);
  end_ns_ = std::max(end_ns_, log_ns);
  ++messages_;
  if (chunk_.size() >= chunking_.bytes || chunk_end_ns_ - chunk_start_ns_ >= chunking_.span_ns)
    close_chunk();
}

void McapBuilder::close_chunk() {
  if (chunk_.empty()) return;
  write_chunk();
  chunk_.clear();
  chunk_entries_.clear();
  chunk_start_ns_ = 0;
  chunk_end_ns_ = 0;
}

void McapBuilder::write_chunk() {
  ++chunks_;
  const std::uint64_t start = position();
  put_record_head(bytes_, McapOp::chunk, 8 + 8 + 8 + 4 + 4 + 8 + chunk_.size());
  put_number(bytes_, chunk_start_ns_, 8);
  put_number(bytes_, chunk_end_ns_, 8);
  put_number(bytes_, chunk_.size(), 8);
  put_number(bytes_, crc32(0, chunk_), 4);
  put_mcap_text(bytes_, "");
  put_number(bytes_, chunk_.size(), 8);
  bytes_ += chunk_;
  std::string index;
  put_number(index, chunk_start_ns_, 8);
  put_number(index, chunk_end_ns_, 8);
  put_number(index, start, 8);
  put_number(index, position() - start, 8);
  write_indexes(index);
  put_mcap_text(index, "");
  put_number(index, chunk_.size(), 8);
  put_number(index, chunk_.size(), 8);
  record(chunk_indexes_, McapOp::chunk_index, index);
}

/// Writes message indexes after the chunk, and their positions into the chunk's index.
void McapBuilder::write_indexes(std::string& index) {
  const std::uint64_t start = position();
  put_number(index, chunk_entries_.size() * (2 + 8), 4);
  for (const auto& [channel, entries] : chunk_entries_) {
    put_number(index, channel, 2);
    put_number(index, position(), 8);
    std::string content;
    put_number(content, channel, 2);
    put_number(content, entries.size() * (8 + 8), 4);
    for (const Entry& entry : entries) {
      put_number(content, entry.log_ns, 8);
      put_number(content, entry.offset, 8);
    }
    record(bytes_, McapOp::message_index, content);
  }
  put_number(index, position() - start, 8);
}

void McapBuilder::add_metadata(const McapMetadata& metadata) {
  close_chunk();
  ++metadata_;
  const std::uint64_t start = position();
  std::string content;
  put_mcap_text(content, metadata.name);
  put_mcap_map(content, metadata.values);
  record(bytes_, McapOp::metadata, content);
  std::string index;
  put_number(index, start, 8);
  put_number(index, position() - start, 8);
  put_mcap_text(index, metadata.name);
  record(metadata_indexes_, McapOp::metadata_index, index);
}

void McapBuilder::add_attachment(const McapAttachmentHead& head, std::string_view data) {
  close_chunk();
  ++attachments_;
  const std::uint64_t start = position();
  std::string content;
  put_number(content, head.log_ns, 8);
  put_number(content, head.create_ns, 8);
  put_mcap_text(content, head.name);
  put_mcap_text(content, head.media_type);
  put_number(content, data.size(), 8);
  content += data;
  put_number(content, crc32(0, content), 4);
  record(bytes_, McapOp::attachment, content);
  std::string index;
  put_number(index, start, 8);
  put_number(index, position() - start, 8);
  put_number(index, head.log_ns, 8);
  put_number(index, head.create_ns, 8);
  put_number(index, data.size(), 8);
  put_mcap_text(index, head.name);
  put_mcap_text(index, head.media_type);
  record(attachment_indexes_, McapOp::attachment_index, index);
}

std::string McapBuilder::take_bytes() {
  data_crc_ = crc32(data_crc_, bytes_);
  taken_ += bytes_.size();
  return std::exchange(bytes_, {});
}

McapMark McapBuilder::mark() const {
  PM_EXPECTS(bytes_.empty() && chunk_.empty());
  return {taken_,
          data_crc_,
          chunk_indexes_.size(),
          attachment_indexes_.size(),
          metadata_indexes_.size(),
          chunks_,
          attachments_,
          metadata_,
          start_ns_,
          end_ns_,
          messages_,
          sequences_};
}

void McapBuilder::rewind(const McapMark& mark) {
  bytes_.clear();
  chunk_.clear();
  chunk_entries_.clear();
  taken_ = mark.bytes;
  data_crc_ = mark.data_crc;
  chunk_indexes_.resize(mark.chunk_index_bytes);
  attachment_indexes_.resize(mark.attachment_index_bytes);
  metadata_indexes_.resize(mark.metadata_index_bytes);
  chunks_ = mark.chunks;
  attachments_ = mark.attachments;
  metadata_ = mark.metadata;
  start_ns_ = mark.start_ns;
  end_ns_ = mark.end_ns;
  messages_ = mark.messages;
  sequences_ = mark.sequences;
  sequences_.resize(channels_.size(), 0);
  schemas_put_ = channels_put_ = 0;
}

void McapBuilder::finish() {
  put_definitions();
  close_chunk();
  std::string content;
  put_number(content, crc32(data_crc_, bytes_), 4);
  record(bytes_, McapOp::data_end, content);
  write_summary();
}

std::string McapBuilder::statistics() const {
  std::string out;
  put_number(out, messages_, 8);
  put_number(out, schemas_.size(), 2);
  put_number(out, channels_.size(), 4);
  put_number(out, attachments_, 4);
  put_number(out, metadata_, 4);
  put_number(out, chunks_, 4);
  put_number(out, start_ns_, 8);
  put_number(out, end_ns_, 8);
  put_number(out, channels_.size() * (2 + 8), 4);
  for (const McapChannel& channel : channels_) {
    put_number(out, channel.id, 2);
    put_number(out, sequences_[channel.id - 1u], 8);
  }
  return out;
}

void McapBuilder::summary_group(McapOp op, std::string_view records, std::string& offsets) {
  if (records.empty()) return;
  std::string content;
  put_number(content, static_cast<std::uint64_t>(op), 1);
  put_number(content, position(), 8);
  put_number(content, records.size(), 8);
  record(offsets, McapOp::summary_offset, content);
  bytes_ += records;
}

void McapBuilder::write_summary() {
  const std::uint64_t start = position();
  const std::size_t start_here = bytes_.size();
  std::string schemas;
  for (const McapSchema& schema : schemas_) record(schemas, McapOp::schema, content_of(schema));
  std::string channels;
  for (const McapChannel& channel : channels_)
    record(channels, McapOp::channel, content_of(channel));
  std::string counted;
  record(counted, McapOp::statistics, statistics());
  std::string offsets;
  summary_group(McapOp::schema, schemas, offsets);
  summary_group(McapOp::channel, channels, offsets);
  summary_group(McapOp::chunk_index, chunk_indexes_, offsets);
  summary_group(McapOp::attachment_index, attachment_indexes_, offsets);
  summary_group(McapOp::metadata_index, metadata_indexes_, offsets);
  summary_group(McapOp::statistics, counted, offsets);
  const std::uint64_t offsets_start = position();
  bytes_ += offsets;
  put_record_head(bytes_, McapOp::footer, mcap_footer_bytes);
  put_number(bytes_, start, 8);
  put_number(bytes_, offsets_start, 8);
  put_number(bytes_, crc32(0, std::string_view(bytes_).substr(start_here)), 4);
  bytes_ += mcap_magic;
}

}  // namespace proofmass::io
