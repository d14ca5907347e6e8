#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/io/mcap/recording.hpp"
#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {

/// Builds an MCAP file in memory, sequentially; the user takes the bytes and writes them. Chunks
/// are uncompressed, so that a file truncated anywhere opens up to its last whole chunk. Each chunk
/// has its checksum and message indexes; the end has a summary with schemas, channels, chunk,
/// attachment and metadata indexes and statistics.
class Builder {
 public:
  explicit Builder(const std::string& library,
                   Chunking chunking = {},
                   const std::string& profile = "");

  /// Both are written before the first message that needs them. Numbers count from 1.
  [[nodiscard]] std::uint16_t add_schema(Schema schema);
  [[nodiscard]] std::uint16_t add_channel(ChannelRecord channel);
  /// Messages of a channel are numbered from 0.
  void add_message(std::uint16_t channel, std::uint64_t log_ns, std::string_view data);
  /// The same with a given sequence number and publish time.
  void add_message(const Message& message);
  /// Both close the preceding chunk.
  void add_metadata(const Metadata& metadata);
  void add_attachment(const AttachmentHead& head, std::string_view data);
  /// Completes the open chunk: the data added so far can be taken and survive a crash.
  void close_chunk();
  /// Writes the end of the data and the summary. Nothing can be added afterwards.
  void finish();

  /// Returns the bytes since the last call.
  [[nodiscard]] std::string take_bytes();
  /// Size of the file, including the open chunk.
  [[nodiscard]] std::uint64_t bytes() const { return position() + chunk_.size(); }
  [[nodiscard]] Mark mark() const;
  void rewind(const Mark& mark);

 private:
  struct Entry {
    std::uint64_t log_ns;
    std::uint64_t offset;
  };
  void record(std::string& out, Op op, std::string_view content);
  void put_definitions();
  [[nodiscard]] std::uint64_t position() const { return taken_ + bytes_.size(); }
  void write_chunk();
  void write_indexes(std::string& index);
  void write_summary();
  void summary_group(Op op, std::string_view records, std::string& offsets);
  [[nodiscard]] std::string statistics() const;

  Chunking chunking_;
  std::string bytes_;
  std::uint64_t taken_ = 0;     ///< bytes returned so far
  std::uint32_t data_crc_ = 0;  ///< checksum of those bytes
  std::vector<Schema> schemas_;
  std::vector<ChannelRecord> channels_;
  std::size_t schemas_put_ = 0;
  std::size_t channels_put_ = 0;
  std::vector<std::uint32_t> sequences_;  ///< number of messages of each channel

  std::string chunk_;
  std::map<std::uint16_t, std::vector<Entry>> chunk_entries_;
  std::uint64_t chunk_start_ns_ = 0;
  std::uint64_t chunk_end_ns_ = 0;

  std::string chunk_indexes_;
  std::string attachment_indexes_;
  std::string metadata_indexes_;
  std::uint32_t chunks_ = 0;
  std::uint32_t attachments_ = 0;
  std::uint32_t metadata_ = 0;
  std::uint64_t start_ns_ = 0;
  std::uint64_t end_ns_ = 0;
  std::uint64_t messages_ = 0;
};

}  // namespace proofmass::io::mcap
