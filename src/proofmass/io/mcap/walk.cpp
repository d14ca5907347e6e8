#include "proofmass/io/mcap/walk.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/io/bytes/crc32.hpp"

namespace proofmass::io::mcap {
namespace {

constexpr std::size_t most_notes = 6;

bool is_wanted(Op op) {
  return op == Op::header || op == Op::schema || op == Op::channel || op == Op::message ||
         op == Op::attachment || op == Op::metadata;
}

/// Maximum size of a record's content held in memory.
std::uint64_t most_held(Op op) {
  constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;
  if (op == Op::chunk || op == Op::message) return most_unpacked + mebibyte;
  return 16 * mebibyte;
}

}  // namespace

Walk::Walk(std::shared_ptr<const RandomBytes> bytes, WalkHints hints)
    : window_(std::move(bytes)), hints_(std::move(hints)) {}

Result<bool> Walk::next(Record& record) {
  for (;;) {
    if (!in_chunk_.empty()) {
      if (next_in_chunk(record)) return true;
      continue;
    }
    if (const Status passed = pass(position_); !passed) return passed.error();
    if (ended_) return false;
    const auto found = step(record);
    if (!found) return found.error();
    if (*found) return true;
  }
}

bool Walk::next_in_chunk(Record& record) {
  Fields fields(in_chunk_);
  const auto op = static_cast<Op>(fields.u8());
  const std::uint64_t length = fields.u64();
  const std::string_view content = fields.take(length);
  if (!fields.is_whole()) {
    note(Severity::bad, fmt::format("the chunk at byte {} breaks off within {}: the records before "
                                    "it are kept",
                                    chunk_at_, record_name(op)));
    in_chunk_ = {};
    return false;
  }
  in_chunk_ = in_chunk_.substr(in_chunk_.size() - fields.left());
  record = {op, content, chunk_at_};
  return op == Op::schema || op == Op::channel || op == Op::message;
}

/// Reads one record of the file; false if it is not of a requested type.
Result<bool> Walk::step(Record& record) {
  const auto head = window_.view(position_, record_head_bytes);
  if (!head) return head.error();
  if (head->empty()) {
    note(Severity::bad,
         fmt::format("ends at byte {} without its closing records, as it was cut off or never "
                     "closed: what was written before is kept",
                     position_));
    ended_ = true;
    return false;
  }
  Fields fields(*head);
  record = {static_cast<Op>(fields.u8()), {}, position_};
  const std::uint64_t length = fields.u64();
  if (!fields.is_whole()) return broken_off("within the head of a record");
  if (record.op == Op{0}) return broken_off("where a record should begin there is a zero");
  const std::uint64_t left = window_.size() - position_ - record_head_bytes;
  if (length > left)
    return broken_off(fmt::format("within {}, of whose {} bytes {} are there",
                                  record_name(record.op), length, left));
  const auto believable = is_believable(record.op, length);
  if (!believable) return believable.error();
  if (!*believable)
    return broken_off(
        fmt::format("where {} of {} bytes cannot be", record_name(record.op), length));
  // If its length is wrong, a chunk may begin within it.
  search_from_ = position_ + 1;
  return enter(length, record);
}

Result<bool> Walk::enter(std::uint64_t length, Record& record) {
  const std::uint64_t content_at = position_ + record_head_bytes;
  if (record.op == Op::footer || record.op == Op::data_end) {
    const auto content = window_.view(content_at, std::min<std::uint64_t>(length, 4));
    if (!content) return content.error();
    const std::string found(*content);
    if (record.op == Op::data_end)
      if (const Status closed = close(found); !closed) return closed.error();
    counts_.is_closed = true;
    ended_ = true;
    return false;
  }
  if (record.op == Op::chunk) {
    const auto entered = enter_chunk(length);
    if (!entered) return entered.error();
    position_ = *entered;
    return false;
  }
  position_ = content_at + length;
  if (!is_wanted(record.op)) return false;
  if (length > most_held(record.op) && record.op != Op::attachment) {
    note(Severity::bad, fmt::format("byte {}: {} of {} bytes is more than is read: skipped",
                                    record.offset, record_name(record.op), length));
    return false;
  }
  const auto content = window_.view(content_at, std::min(length, most_held(record.op)));
  if (!content) return content.error();
  record.content = *content;
  return true;
}

/// Returns the position of the record after the chunk.
Result<std::uint64_t> Walk::enter_chunk(std::uint64_t length) {
  chunk_at_ = position_;
  constexpr std::uint64_t most_head_bytes = 4096;
  const std::uint64_t content_at = position_ + record_head_bytes;
  const std::uint64_t end = content_at + length;
  const auto start = window_.view(content_at, std::min(length, most_head_bytes));
  if (!start) return start.error();
  const auto head = parse_chunk_head(*start);
  if (!head || head->packed_bytes > length - head->head_bytes)
    return lose_chunk({}, end, "its head is damaged");
  if (head->packed_bytes > most_unpacked || head->unpacked_bytes > most_unpacked)
    return lose_chunk(*head, end, "it is larger than 1 GiB");
  // The whole record, so that the checksum of the data section finds it in the window.
  const std::uint64_t before = record_head_bytes + head->head_bytes;
  const auto whole = window_.view(position_, before + head->packed_bytes);
  if (!whole) return whole.error();
  const auto unpacked = unpacker_.unpack(*head, whole->substr(std::min(before, whole->size())));
  if (!unpacked) return lose_chunk(*head, end, unpacked.error().message);
  in_chunk_ = *unpacked;
  ++counts_.chunks;
  // The checksum validates the inner length; nothing validates the outer one.
  if (hints_.search) search_from_ = position_ + before + head->packed_bytes;
  return hints_.search ? search_from_ : end;
}

/// Updates the checksum of the data section; the bytes are still in the window.
Status Walk::pass(std::uint64_t end) {
  constexpr std::uint64_t piece = std::uint64_t{1} << 20;
  while (hints_.check_data && passed_ < end) {
    const auto bytes = window_.view(passed_, std::min(end - passed_, piece));
    if (!bytes) return bytes.error();
    if (bytes->empty()) break;
    data_crc_ = crc32(data_crc_, *bytes);
    passed_ += bytes->size();
  }
  return Done{};
}

Status Walk::close(std::string_view data_end) {
  const std::uint32_t expected = Fields(data_end).u32();
  if (!hints_.check_data || expected == 0 || counts_.damaged_chunks > 0) return Done{};
  if (const Status passed = pass(position_); !passed) return passed.error();
  if (data_crc_ != expected)
    note(Severity::bad,
         "the checksum of the data section is wrong: some byte is damaged that no checksum of a "
         "chunk stands for");
  return Done{};
}

void Walk::note(Severity severity, std::string text) {
  if (notes_.size() < most_notes) notes_.push_back({severity, std::move(text)});
}

std::vector<Note> Walk::notes() const {
  std::vector<Note> notes = notes_;
  if (counts_.damaged_chunks > 1)
    notes.push_back(
        {Severity::bad, fmt::format("{} chunks are skipped in all", counts_.damaged_chunks)});
  return notes;
}

double Walk::fraction_read() const {
  return static_cast<double>(std::min(position_, window_.size())) /
         static_cast<double>(std::max<std::uint64_t>(window_.size(), 1));
}

}  // namespace proofmass::io::mcap
