#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/file_window.hpp"
#include "proofmass/io/mcap/records.hpp"
#include "proofmass/io/mcap/unpack.hpp"

namespace proofmass::io::mcap {

/// A record at any level.
struct Record {
  Op op = Op::header;
  std::string_view content;  ///< valid until the next record; at most 16 MiB of an attachment
  std::uint64_t offset = 0;  ///< file offset of the record, or of its chunk
};

/// Information on a file beyond its records.
struct WalkHints {
  /// Start of the chunks, ascending: after damage the walk continues at the next one.
  std::vector<std::uint64_t> chunk_starts{};
  bool check_data = false;  ///< verify the checksum of the whole data section, if it has one
  /// After damage the walk continues at the next bytes that form an intact chunk.
  bool search = false;
};

/// Counts of a walk.
struct WalkCounts {
  std::uint64_t chunks = 0;  ///< intact chunks
  std::uint64_t damaged_chunks = 0;
  std::uint64_t skipped = 0;  ///< bytes of the file, including those at its end
  bool is_closed = false;     ///< the end of the data section is present
};

/// Walks through the data section of an MCAP file, including its chunks. Chunks with a wrong
/// checksum, or that cannot be decompressed, are skipped; so is everything from an impossible
/// length to the next chunk known from the hints. All of this is reported in notes().
/// Cost: one chunk in memory, compressed and decompressed.
class Walk {
 public:
  Walk(std::shared_ptr<const RandomBytes> bytes, WalkHints hints);

  /// The next header, schema, channel, message, attachment or metadata; false at the end of the
  /// data section, or of the file. Errors: unreadable.
  [[nodiscard]] Result<bool> next(Record& record);
  /// Damaged or missing parts; complete once next() has returned false.
  [[nodiscard]] std::vector<Note> notes() const;
  /// Upper bound of the message bytes in the skipped chunks.
  [[nodiscard]] std::uint64_t lost_bytes() const { return lost_bytes_; }
  [[nodiscard]] double fraction_read() const;
  /// Complete once next() has returned false.
  [[nodiscard]] const WalkCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] bool next_in_chunk(Record& record);
  [[nodiscard]] Result<bool> step(Record& record);
  [[nodiscard]] Result<bool> enter(std::uint64_t length, Record& record);
  [[nodiscard]] Result<std::uint64_t> enter_chunk(std::uint64_t length);
  [[nodiscard]] Status pass(std::uint64_t end);
  [[nodiscard]] Status close(std::string_view data_end);
  [[nodiscard]] Result<bool> broken_off(const std::string& why);
  [[nodiscard]] Result<bool> is_believable(Op op, std::uint64_t length);
  [[nodiscard]] Result<bool> is_record_at(std::uint64_t at);
  [[nodiscard]] Result<std::uint64_t> next_chunk(std::uint64_t from);
  [[nodiscard]] Result<bool> is_chunk(std::uint64_t at);
  [[nodiscard]] Result<std::uint64_t> lose_chunk(const ChunkHead& head,
                                                 std::uint64_t end,
                                                 const std::string& why);
  void skip(std::uint64_t from, std::uint64_t to);
  void note(Severity severity, std::string text);

  FileWindow window_;
  WalkHints hints_;
  Unpacker unpacker_;
  std::string_view in_chunk_;   ///< remainder of the chunk
  std::uint64_t chunk_at_ = 0;  ///< start of that chunk
  std::uint64_t position_ = 8;  ///< end of the last record
  std::uint64_t passed_ = 0;    ///< bytes included in data_crc_
  std::uint32_t data_crc_ = 0;
  bool ended_ = false;
  std::uint64_t lost_bytes_ = 0;
  std::uint64_t skipped_to_ = 0;   ///< end of the last bytes counted as skipped
  std::uint64_t search_from_ = 8;  ///< end of the data known to be intact
  std::uint64_t searched_ = 0;     ///< bytes searched without result
  WalkCounts counts_;
  std::vector<Note> notes_;
};

}  // namespace proofmass::io::mcap
