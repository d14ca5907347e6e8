#include "proofmass/io/mcap/summary.hpp"

#include <algorithm>

#include "proofmass/io/bytes/crc32.hpp"

namespace proofmass::io::mcap {
namespace {

constexpr std::uint64_t end_bytes = record_head_bytes + footer_bytes + magic.size();
constexpr std::uint64_t data_end_bytes = record_head_bytes + 4;

/// The footer of a properly closed file.
Result<std::optional<Footer>> read_footer(FileWindow& window) {
  using Found = std::optional<Footer>;
  if (window.size() < magic.size() + end_bytes) return Found();
  const auto end = window.view(window.size() - end_bytes, end_bytes);
  if (!end) return end.error();
  Fields fields(*end);
  const bool is_footer = static_cast<Op>(fields.u8()) == Op::footer &&
                         fields.u64() == footer_bytes && end->ends_with(magic);
  if (!is_footer) return Found();
  return Found(parse_footer(fields.take(footer_bytes)));
}

/// Takes the number of messages of each channel; false if they are not those of the file.
bool take_counts(std::string_view content, Summary& out) {
  const auto statistics = parse_statistics(content);
  if (!statistics) return false;
  out.messages = statistics->of_channels;
  std::uint64_t sum = 0;
  for (const auto& [channel, count] : out.messages)
    if (__builtin_add_overflow(sum, count, &sum)) return false;
  return sum == statistics->messages;
}

void take_record(Op op, std::string_view content, Summary& out) {
  if (op == Op::chunk_index) {
    Fields index(content);
    index.take(16);
    out.chunk_starts.push_back(index.u64());
  } else if (op == Op::schema) {
    if (auto schema = parse_schema(content)) out.schemas.push_back(std::move(*schema));
  } else if (op == Op::channel) {
    if (auto channel = parse_channel(content)) out.channels.push_back(std::move(*channel));
  }
}

/// nullopt if a record is truncated or the messages are not counted.
std::optional<Summary> parsed_summary(std::string_view records) {
  Summary out;
  bool is_counted = false;
  for (Fields fields(records); fields.left() > 0;) {
    const auto op = static_cast<Op>(fields.u8());
    const std::string_view content = fields.take(fields.u64());
    if (!fields.is_whole()) return std::nullopt;
    if (op == Op::statistics)
      is_counted = take_counts(content, out);
    else
      take_record(op, content, out);
  }
  std::ranges::sort(out.chunk_starts);
  return is_counted ? std::optional(std::move(out)) : std::nullopt;
}

Result<bool> has_data_checksum(FileWindow& window, std::uint64_t data_end) {
  const auto record = window.view(data_end, data_end_bytes);
  if (!record) return record.error();
  Fields fields(*record);
  return static_cast<Op>(fields.u8()) == Op::data_end && fields.u64() >= 4 && fields.u32() != 0;
}

}  // namespace

Result<std::optional<Summary>> read_summary(FileWindow& window, std::vector<Note>& notes) {
  using Found = std::optional<Summary>;
  const auto footer = read_footer(window);
  if (!footer) return footer.error();
  if (!*footer || (*footer)->summary_start == 0) return Found();
  const std::uint64_t start = (*footer)->summary_start;
  const std::uint64_t end = window.size() - end_bytes;
  const auto refused = [&](const char* why) {
    notes.push_back({Severity::warning, std::string("the summary at the end of the file ") + why +
                                            ": all records were looked at instead"});
    return Found();
  };
  constexpr std::uint64_t most_bytes = std::uint64_t{256} << 20;
  if (start < magic.size() + data_end_bytes || start > end || end - start > most_bytes)
    return refused("begins where it cannot");
  // The checksum covers the footer up to the checksum itself.
  const std::uint64_t checked = end - start + record_head_bytes + footer_bytes - 4;
  const auto bytes = window.view(start, checked);
  if (!bytes) return bytes.error();
  if ((*footer)->summary_crc != 0 && crc32(0, *bytes) != (*footer)->summary_crc)
    return refused("is damaged (its checksum is wrong)");
  Found summary = parsed_summary(bytes->substr(0, end - start));
  if (!summary) return Found();
  const auto has_checksum = has_data_checksum(window, start - data_end_bytes);
  if (!has_checksum) return has_checksum.error();
  summary->has_data_checksum = *has_checksum;
  return summary;
}

}  // namespace proofmass::io::mcap
