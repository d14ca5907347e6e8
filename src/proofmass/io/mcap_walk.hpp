#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/file_window.hpp"
#include "proofmass/io/mcap_records.hpp"
#include "proofmass/io/mcap_unpack.hpp"

namespace proofmass::io {

/// A record, wherever it stands.
struct McapRecord {
  McapOp op = McapOp::header;
  std::string_view content;  ///< valid until the next record; of an attachment 16 MiB at most
  std::uint64_t offset = 0;  ///< byte of the file at which it begins, or its chunk
};

/// What is known of a file beside its records.
struct McapWalkHints {
  /// Where chunks begin, ascending: after damage the walk goes on at the next of them.
  std::vector<std::uint64_t> chunk_starts{};
  bool check_data = false;  ///< compare the checksum of the whole data section, if it has one
  /// After damage the walk goes on at the next bytes that are a whole chunk, wherever they are.
  bool search = false;
};

/// What a walk came across.
struct McapWalkCounts {
  std::uint64_t chunks = 0;  ///< that were whole
  std::uint64_t damaged_chunks = 0;
  std::uint64_t passed_over = 0;  ///< bytes of the file, with those at its end
  bool is_closed = false;         ///< the end of the data section is there
};

/// Goes through the data section of an MCAP file from front to end, into its chunks too.
/// Chunks that fail their checksum or cannot be unpacked are passed over; what comes after a length
/// that cannot be, and before a chunk that the hints know, too. All that is told in notes().
/// Cost: one chunk in memory, packed and unpacked.
class McapWalk {
 public:
  McapWalk(std::shared_ptr<const RandomBytes> bytes, McapWalkHints hints);

  /// The next header, schema, channel, message, attachment or metadata; false at the end of the
  /// data section, or of the file. Errors: unreadable.
  [[nodiscard]] Result<bool> next(McapRecord& record);
  /// What is damaged or missing; complete once next() has said false.
  [[nodiscard]] std::vector<Note> notes() const;
  /// How many bytes of messages can at most have been in the chunks that were passed over.
  [[nodiscard]] std::uint64_t lost_bytes() const { return lost_bytes_; }
  [[nodiscard]] double fraction_read() const;
  /// Complete once next() has said false.
  [[nodiscard]] const McapWalkCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] bool next_in_chunk(McapRecord& record);
  [[nodiscard]] Result<bool> step(McapRecord& record);
  [[nodiscard]] Result<bool> enter(std::uint64_t length, McapRecord& record);
  [[nodiscard]] Result<std::uint64_t> enter_chunk(std::uint64_t length);
  [[nodiscard]] Status pass(std::uint64_t end);
  [[nodiscard]] Status close(std::string_view data_end);
  [[nodiscard]] Result<bool> broken_off(const std::string& why);
  [[nodiscard]] Result<bool> is_believable(McapOp op, std::uint64_t length);
  [[nodiscard]] Result<bool> is_record_at(std::uint64_t at);
  [[nodiscard]] Result<std::uint64_t> next_chunk(std::uint64_t from);
  [[nodiscard]] Result<bool> is_chunk(std::uint64_t at);
  [[nodiscard]] Result<std::uint64_t> lose_chunk(const McapChunkHead& head,
                                                 std::uint64_t end,
                                                 const std::string& why);
  void note(Severity severity, std::string text);

  FileWindow window_;
  McapWalkHints hints_;
  McapUnpacker unpacker_;
  std::string_view in_chunk_;   ///< what is left of the chunk
  std::uint64_t chunk_at_ = 0;  ///< where that chunk begins
  std::uint64_t position_ = 8;  ///< behind the record that was taken last
  std::uint64_t passed_ = 0;    ///< bytes whose checksum is in data_crc_
  std::uint32_t data_crc_ = 0;
  bool ended_ = false;
  std::uint64_t lost_bytes_ = 0;
  std::uint64_t search_from_ = 8;  ///< behind what is surely whole
  std::uint64_t searched_ = 0;     ///< bytes that were looked at in vain
  McapWalkCounts counts_;
  std::vector<Note> notes_;
};

}  // namespace proofmass::io
