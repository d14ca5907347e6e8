#include <algorithm>
#include <fmt/format.h>

#include "proofmass/io/mcap/walk.hpp"

// Damaged bytes: the loss, and where the walk continues.
namespace proofmass::io::mcap {
namespace {

/// "1700000000.125 s"
std::string seconds(std::uint64_t ns) {
  return fmt::format("{}.{:03} s", ns / 1'000'000'000, ns / 1'000'000 % 1000);
}

}  // namespace

/// Counts bytes as lost, each once: where a whole chunk begins within what was skipped, the walk
/// goes back.
void Walk::skip(std::uint64_t from, std::uint64_t to) {
  if (to < skipped_to_)
    counts_.skipped -= std::min(counts_.skipped, skipped_to_ - to);
  else
    counts_.skipped += to - std::clamp(skipped_to_, from, to);
  skipped_to_ = to;
}

/// Continues after damage, if possible; there is no record yet.
Result<bool> Walk::broken_off(const std::string& why) {
  const auto listed = std::ranges::upper_bound(hints_.chunk_starts, position_);
  std::uint64_t next = listed == hints_.chunk_starts.end() ? window_.size() : *listed;
  if (hints_.search) {
    const auto found = next_chunk(search_from_);
    if (!found) return found.error();
    next = *found;
    position_ = std::min(position_, next);
  }
  hints_.check_data = false;
  if (next >= window_.size()) {
    note(Severity::bad,
         fmt::format("breaks off at byte {}, {}: what was read before is kept", position_, why));
    skip(position_, window_.size());
    ended_ = true;
    return false;
  }
  note(
      Severity::bad,
      fmt::format("is damaged at byte {}, {}: skipped up to byte {}, where {}", position_, why,
                  next, hints_.search ? "a whole chunk begins" : "the summary has the next chunk"));
  lost_bytes_ += next - position_;
  skip(position_, next);
  position_ = next;
  return false;
}

/// True if a plausible record header begins a record: checked only if the walk can continue without
/// it.
Result<bool> Walk::is_believable(Op op, std::uint64_t length) {
  if (!hints_.search || op == Op::chunk) return true;
  const std::uint64_t end = position_ + record_head_bytes + length;
  constexpr std::uint64_t longest_data_end = 64;
  if (op == Op::data_end) return length <= longest_data_end;
  if (op == Op::footer) return end + magic.size() == window_.size();
  return op < Op::data_end ? Result(true) : is_record_at(end);
}

/// True if a record can begin there, or the file ends.
Result<bool> Walk::is_record_at(std::uint64_t at) {
  if (at == window_.size()) return true;
  const auto next = window_.view(at, 1);
  if (!next) return next.error();
  const auto kind = static_cast<unsigned char>(next->empty() ? 0 : next->front());
  constexpr unsigned char first_private = 0x80;
  return (kind > 0 && kind <= static_cast<unsigned char>(Op::data_end)) || kind >= first_private;
}

/// The first intact chunk from byte `from`; the file's end if there is none.
Result<std::uint64_t> Walk::next_chunk(std::uint64_t from) {
  constexpr std::uint64_t piece = std::uint64_t{64} << 10;
  // Each attempt costs the checksum of a chunk: malicious bytes would make the search endless.
  const std::uint64_t most_searched = 8 * window_.size() + (std::uint64_t{64} << 20);
  for (std::uint64_t at = from; at < window_.size() && searched_ < most_searched;) {
    const auto bytes = window_.view(at, piece);
    if (!bytes) return bytes.error();
    const std::size_t found = bytes->find(static_cast<char>(Op::chunk));
    if (found == std::string_view::npos) {
      at += bytes->size();
      continue;
    }
    at += found;
    const auto whole = is_chunk(at);
    if (!whole) return whole.error();
    if (*whole) return at;
    ++at;
  }
  return window_.size();
}

Result<bool> Walk::is_chunk(std::uint64_t at) {
  constexpr std::uint64_t most_head_bytes = 128;
  const auto start = window_.view(at, record_head_bytes + most_head_bytes);
  if (!start) return start.error();
  Fields fields(*start);
  fields.u8();
  const std::uint64_t length = fields.u64();
  const auto head = parse_chunk_head(start->substr(std::min(start->size(), record_head_bytes)));
  const bool is_sound = fields.is_whole() && head && head->packed_bytes <= most_unpacked &&
                        head->head_bytes + head->packed_bytes == length &&
                        length <= window_.size() - at - record_head_bytes && head->packed_bytes > 0;
  if (!is_sound) return false;
  const std::uint64_t before = record_head_bytes + head->head_bytes;
  const auto whole = window_.view(at, before + head->packed_bytes);
  if (!whole) return whole.error();
  searched_ += head->packed_bytes;
  return unpacker_.unpack(*head, whole->substr(before)).has_value();
}

/// Returns where to continue: after it, or at the next chunk if its length is invalid too.
Result<std::uint64_t> Walk::lose_chunk(const ChunkHead& head,
                                       std::uint64_t end,
                                       const std::string& why) {
  ++counts_.damaged_chunks;
  constexpr std::uint64_t usual_ratio = 64;
  lost_bytes_ += std::min(head.unpacked_bytes, usual_ratio * head.packed_bytes);
  note(Severity::bad,
       fmt::format("the chunk at byte {} ({} … {} on the clock of the file) is skipped: {}",
                   chunk_at_, seconds(head.start_ns), seconds(head.end_ns), why));
  if (hints_.search) {
    const auto follows = is_record_at(end);
    if (!follows) return follows.error();
    const auto next = *follows && head.packed_bytes > 0 ? Result(end) : next_chunk(search_from_);
    if (!next) return next.error();
    end = *next;
  }
  skip(chunk_at_, end);
  return end;
}

}  // namespace proofmass::io::mcap
