#include "proofmass/io/mcap/builder.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/bytes/crc32.hpp"
#include "proofmass/io/mcap/put.hpp"

namespace proofmass::io::mcap {
Builder::Builder(const std::string& library, Chunking chunking, const std::string& profile)
    : chunking_(chunking), bytes_(magic) {
  std::string content;
  put_text(content, profile);
  put_text(content, library);
  record(bytes_, Op::header, content);
}

void Builder::record(std::string& out, Op op, std::string_view content) {
  put_record_head(out, op, content.size());
  out += content;
}

std::uint16_t Builder::add_schema(Schema schema) {
  PM_EXPECTS(schemas_.size() < 0xFFFF);
  schema.id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back(std::move(schema));
  return schemas_.back().id;
}

std::uint16_t Builder::add_channel(ChannelRecord channel) {
  PM_EXPECTS(channels_.size() < 0xFFFF);
  channel.id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back(std::move(channel));
  sequences_.push_back(0);
  return channels_.back().id;
}

void Builder::put_definitions() {
  for (; schemas_put_ < schemas_.size(); ++schemas_put_)
    record(chunk_, Op::schema, content_of(schemas_[schemas_put_]));
  for (; channels_put_ < channels_.size(); ++channels_put_)
    record(chunk_, Op::channel, content_of(channels_[channels_put_]));
}

void Builder::add_message(std::uint16_t channel, std::uint64_t log_ns, std::string_view data) {
  PM_EXPECTS(channel > 0 && channel <= channels_.size());
  add_message({channel, sequences_[channel - 1u], log_ns, log_ns, data});
}

void Builder::add_message(const Message& message) {
  PM_EXPECTS(message.channel > 0 && message.channel <= channels_.size());
  if (chunking_.is_self_contained && chunk_.empty()) schemas_put_ = channels_put_ = 0;
  put_definitions();
  const std::uint64_t log_ns = message.log_ns;
  const bool is_first = chunk_entries_.empty();
  chunk_start_ns_ = is_first ? log_ns : std::min(chunk_start_ns_, log_ns);
  chunk_end_ns_ = is_first ? log_ns : std::max(chunk_end_ns_, log_ns);
  chunk_entries_[message.channel].push_back({log_ns, chunk_.size()});
  put_record_head(chunk_, Op::message, 2 + 4 + 8 + 8 + message.data.size());
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

void Builder::close_chunk() {
  if (chunk_.empty()) return;
  write_chunk();
  chunk_.clear();
  chunk_entries_.clear();
  chunk_start_ns_ = 0;
  chunk_end_ns_ = 0;
}

void Builder::write_chunk() {
  ++chunks_;
  const std::uint64_t start = position();
  put_record_head(bytes_, Op::chunk, 8 + 8 + 8 + 4 + 4 + 8 + chunk_.size());
  put_number(bytes_, chunk_start_ns_, 8);
  put_number(bytes_, chunk_end_ns_, 8);
  put_number(bytes_, chunk_.size(), 8);
  put_number(bytes_, crc32(0, chunk_), 4);
  put_text(bytes_, "");
  put_number(bytes_, chunk_.size(), 8);
  bytes_ += chunk_;
  std::string index;
  put_number(index, chunk_start_ns_, 8);
  put_number(index, chunk_end_ns_, 8);
  put_number(index, start, 8);
  put_number(index, position() - start, 8);
  write_indexes(index);
  put_text(index, "");
  put_number(index, chunk_.size(), 8);
  put_number(index, chunk_.size(), 8);
  record(chunk_indexes_, Op::chunk_index, index);
}

/// Writes message indexes after the chunk, and their positions into the chunk's index.
void Builder::write_indexes(std::string& index) {
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
    record(bytes_, Op::message_index, content);
  }
  put_number(index, position() - start, 8);
}

void Builder::add_metadata(const Metadata& metadata) {
  close_chunk();
  ++metadata_;
  const std::uint64_t start = position();
  std::string content;
  put_text(content, metadata.name);
  put_map(content, metadata.values);
  record(bytes_, Op::metadata, content);
  std::string index;
  put_number(index, start, 8);
  put_number(index, position() - start, 8);
  put_text(index, metadata.name);
  record(metadata_indexes_, Op::metadata_index, index);
}

void Builder::add_attachment(const AttachmentHead& head, std::string_view data) {
  close_chunk();
  ++attachments_;
  const std::uint64_t start = position();
  std::string content;
  put_number(content, head.log_ns, 8);
  put_number(content, head.create_ns, 8);
  put_text(content, head.name);
  put_text(content, head.media_type);
  put_number(content, data.size(), 8);
  content += data;
  put_number(content, crc32(0, content), 4);
  record(bytes_, Op::attachment, content);
  std::string index;
  put_number(index, start, 8);
  put_number(index, position() - start, 8);
  put_number(index, head.log_ns, 8);
  put_number(index, head.create_ns, 8);
  put_number(index, data.size(), 8);
  put_text(index, head.name);
  put_text(index, head.media_type);
  record(attachment_indexes_, Op::attachment_index, index);
}

std::string Builder::take_bytes() {
  data_crc_ = crc32(data_crc_, bytes_);
  taken_ += bytes_.size();
  return std::exchange(bytes_, {});
}

Mark Builder::mark() const {
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

void Builder::rewind(const Mark& mark) {
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

void Builder::finish() {
  put_definitions();
  close_chunk();
  std::string content;
  put_number(content, crc32(data_crc_, bytes_), 4);
  record(bytes_, Op::data_end, content);
  write_summary();
}

std::string Builder::statistics() const {
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
  for (const ChannelRecord& channel : channels_) {
    put_number(out, channel.id, 2);
    put_number(out, sequences_[channel.id - 1u], 8);
  }
  return out;
}

void Builder::summary_group(Op op, std::string_view records, std::string& offsets) {
  if (records.empty()) return;
  std::string content;
  put_number(content, static_cast<std::uint64_t>(op), 1);
  put_number(content, position(), 8);
  put_number(content, records.size(), 8);
  record(offsets, Op::summary_offset, content);
  bytes_ += records;
}

void Builder::write_summary() {
  const std::uint64_t start = position();
  const std::size_t start_here = bytes_.size();
  std::string schemas;
  for (const Schema& schema : schemas_) record(schemas, Op::schema, content_of(schema));
  std::string channels;
  for (const ChannelRecord& channel : channels_) record(channels, Op::channel, content_of(channel));
  std::string counted;
  record(counted, Op::statistics, statistics());
  std::string offsets;
  summary_group(Op::schema, schemas, offsets);
  summary_group(Op::channel, channels, offsets);
  summary_group(Op::chunk_index, chunk_indexes_, offsets);
  summary_group(Op::attachment_index, attachment_indexes_, offsets);
  summary_group(Op::metadata_index, metadata_indexes_, offsets);
  summary_group(Op::statistics, counted, offsets);
  const std::uint64_t offsets_start = position();
  bytes_ += offsets;
  put_record_head(bytes_, Op::footer, footer_bytes);
  put_number(bytes_, start, 8);
  put_number(bytes_, offsets_start, 8);
  put_number(bytes_, crc32(0, std::string_view(bytes_).substr(start_here)), 4);
  bytes_ += magic;
}

}  // namespace proofmass::io::mcap
