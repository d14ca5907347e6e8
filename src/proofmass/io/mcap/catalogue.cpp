#include "proofmass/io/mcap/catalogue.hpp"

#include <set>
#include <utility>

#include "proofmass/io/mcap/summary.hpp"

namespace proofmass::io::mcap {
namespace {

/// Fills a catalogue from as many records as needed.
class Cataloguer {
 public:
  Cataloguer(Catalogue& out, bool counts) : out_(out), counts_(counts) {
    for (const auto& [channel, messages] : out.messages)
      if (messages > 0) missing_.insert(channel);
  }

  [[nodiscard]] bool is_complete() const { return !counts_ && missing_.empty(); }

  void take(const Record& record) {
    if (record.op == Op::header) {
      Fields fields(record.content);
      out_.profile = fields.text();
      out_.library = fields.text();
    } else if (record.op == Op::schema) {
      take_schema(record.content);
    } else if (record.op == Op::channel) {
      take_channel(record.content);
    } else if (record.op == Op::message) {
      take_message(record.content);
    }
  }

 private:
  bool has_room_for(std::size_t bytes) {
    constexpr std::size_t most_kept = std::size_t{64} << 20;
    if (bytes > most_kept - kept_) return false;
    kept_ += bytes;
    return true;
  }

  void take_schema(std::string_view content) {
    auto schema = parse_schema(content);
    if (schema && schema->id != 0 && !out_.schemas.contains(schema->id) &&
        has_room_for(content.size()))
      out_.schemas.emplace(schema->id, std::move(*schema));
  }

  void take_channel(std::string_view content) {
    auto channel = parse_channel(content);
    if (channel && !out_.channels.contains(channel->id) && has_room_for(content.size()))
      out_.channels.emplace(channel->id, std::move(*channel));
  }

  void take_message(std::string_view content) {
    const auto message = parse_message(content);
    if (!message || !out_.channels.contains(message->channel)) return;
    missing_.erase(message->channel);
    if (counts_) ++out_.messages[message->channel];
    if (out_.firsts.contains(message->channel)) return;
    constexpr std::size_t longest = std::size_t{1} << 20;
    const std::string_view data = message->data.substr(0, longest);
    out_.firsts.emplace(
        message->channel,
        FirstMessage{message->log_ns, has_room_for(data.size()) ? std::string(data) : ""});
  }

  Catalogue& out_;
  bool counts_;
  std::set<std::uint16_t> missing_;  ///< channels whose first message has not been read yet
  std::size_t kept_ = 0;
};

}  // namespace

Result<Catalogue> read_catalogue(const std::shared_ptr<const RandomBytes>& bytes) {
  Catalogue out;
  FileWindow window(bytes);
  auto summary = read_summary(window, out.notes);
  if (!summary) return summary.error();
  if (*summary) {
    Summary found = **summary;
    out.messages = std::move(found.messages);
    out.hints.chunk_starts = std::move(found.chunk_starts);
    out.hints.check_data = found.has_data_checksum;
  }
  Cataloguer cataloguer(out, !*summary);
  Walk walk(bytes, {out.hints.chunk_starts, false});
  Record record;
  while (!cataloguer.is_complete()) {
    const auto found = walk.next(record);
    if (!found) return found.error();
    if (!*found) break;
    cataloguer.take(record);
  }
  out.damage = walk.notes();
  return out;
}

}  // namespace proofmass::io::mcap
