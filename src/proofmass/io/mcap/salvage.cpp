#include "proofmass/io/mcap/salvage.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "proofmass/core/version.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/bytes/file_window.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/mcap/builder.hpp"
#include "proofmass/io/mcap/put.hpp"
#include "proofmass/io/mcap/rows_account.hpp"
#include "proofmass/io/mcap/summary.hpp"
#include "proofmass/io/mcap/walk.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {
namespace {

constexpr std::size_t most_definitions = 0xFFFF;  ///< schemas or channels per file

/// The new file, built while the old one is read.
class Salvager {
 public:
  explicit Salvager(const Summary& summary) {
    for (const Schema& schema : summary.schemas) schemas_[schema.id] = {schema, 0};
    for (const ChannelRecord& channel : summary.channels) channels_[channel.id] = {channel, 0};
  }

  void take(const Record& record) {
    if (record.op == Op::header) {
      Fields fields(record.content);
      profile_ = fields.text();
      library_ = fields.text();
    } else if (record.op == Op::schema) {
      if (auto schema = parse_schema(record.content)) define(schemas_, std::move(*schema));
    } else if (record.op == Op::channel) {
      if (auto channel = parse_channel(record.content)) define(channels_, std::move(*channel));
    } else if (record.op == Op::message) {
      take_message(record);
    } else if (record.op == Op::metadata) {
      if (const auto metadata = parse_metadata(record.content)) builder().add_metadata(*metadata);
    } else if (record.op == Op::attachment) {
      take_attachment(record);
    }
  }

  [[nodiscard]] Builder& builder() {
    if (!builder_)
      builder_ = std::make_unique<Builder>(
          fmt::format("proofmass {}, saved from what was written by {}", version(),
                      library_.empty() ? "an unnamed program" : shown(library_)),
          Chunking{.is_self_contained = true}, profile_);
    return *builder_;
  }
  [[nodiscard]] bool has_anything() const { return builder_ != nullptr; }

  void report(Recovery& out) const {
    out.messages = messages_;
    rows_.report(out);
    if (undefined_ > 0)
      out.notes.push_back(
          {Severity::bad, fmt::format("{} messages are left out, as the records that say what they "
                                      "are (channels) are lost",
                                      undefined_)});
    out.notes.insert(out.notes.end(), notes_.begin(), notes_.end());
  }

 private:
  template <class Record>
  struct Defined {
    Record record;
    std::uint16_t number = 0;  ///< in the new file; 0: not written yet
  };
  template <class Record>
  using Definitions = std::map<std::uint16_t, Defined<Record>>;

  /// A reused number with another meaning gets a new number.
  template <class Record>
  static void define(Definitions<Record>& known, Record record) {
    const std::uint16_t id = record.id;
    const auto found = known.find(id);
    if (found != known.end() && content_of(found->second.record) == content_of(record)) return;
    known[id] = {std::move(record), 0};
  }

  [[nodiscard]] std::uint16_t schema_number(std::uint16_t id) {
    const auto found = schemas_.find(id);
    if (id == 0 || found == schemas_.end() || schema_count_ == most_definitions) return 0;
    if (found->second.number == 0) {
      found->second.number = builder().add_schema(found->second.record);
      ++schema_count_;
    }
    return found->second.number;
  }

  /// 0 if the channel is not defined.
  [[nodiscard]] std::uint16_t channel_number(std::uint16_t id) {
    const auto found = channels_.find(id);
    if (found == channels_.end()) return 0;
    Defined<ChannelRecord>& channel = found->second;
    if (channel.number == 0 && channel_count_ < most_definitions) {
      ChannelRecord copy = channel.record;
      copy.schema = schema_number(copy.schema);
      channel.number = builder().add_channel(std::move(copy));
      ++channel_count_;
    }
    return channel.number;
  }

  void take_message(const Record& record) {
    auto message = parse_message(record.content);
    if (!message) return;
    const std::uint16_t number = channel_number(message->channel);
    if (number == 0) {
      ++undefined_;
      return;
    }
    rows_.add(channels_.at(message->channel).record, *message);
    message->channel = number;
    builder().add_message(*message);
    ++messages_;
  }

  void take_attachment(const Record& record) {
    const auto head = parse_attachment_head(record.content);
    if (!head) return;
    if (const auto data = attachment_data(record.content, *head)) {
      builder().add_attachment(*head, *data);
      return;
    }
    constexpr std::size_t most_listed = 8;
    if (notes_.size() < most_listed)
      notes_.push_back(
          {Severity::bad, fmt::format("the attachment {} at byte {} is left out: it is "
                                      "damaged, or larger than 16 MiB",
                                      shown(head->name), record.offset)});
  }

  std::string profile_, library_;
  std::unique_ptr<Builder> builder_;
  Definitions<Schema> schemas_;
  Definitions<ChannelRecord> channels_;
  std::size_t schema_count_ = 0, channel_count_ = 0;
  std::uint64_t messages_ = 0, undefined_ = 0;
  RowsAccount rows_;
  std::vector<Note> notes_;
};

Result<Recovery> salvage(const std::shared_ptr<const RandomBytes>& bytes,
                         const PutBytes& put,
                         const Progress& progress) {
  FileWindow window(bytes);
  Recovery out;
  out.bytes_read = bytes->size();
  const auto head = window.view(0, magic.size());
  if (!head) return head.error();
  if (*head != magic) out.notes.push_back({Severity::bad, "does not begin as an MCAP file does"});
  const auto summary = read_summary(window, out.notes);
  if (!summary) return summary.error();
  const Summary known = summary->value_or(Summary{});
  Salvager salvager(known);
  Walk walk(bytes, {.check_data = known.has_data_checksum, .search = true});
  const auto put_on = [&](Builder& builder) {
    const std::string ready = builder.take_bytes();
    return ready.empty() ? Status(Done{}) : put(ready);
  };
  Record record;
  for (;;) {
    const auto found = walk.next(record);
    if (!found) return found.error();
    if (!*found) break;
    salvager.take(record);
    if (!salvager.has_anything()) continue;
    if (const Status done = put_on(salvager.builder()); !done) return done.error();
    if (progress) progress("recovering", walk.fraction_read());
  }
  if (!salvager.has_anything())
    return Error{Errc::corrupt,
                 "no message, metadata or attachment of an MCAP file is whole in it"};
  salvager.builder().finish();
  if (const Status done = put_on(salvager.builder()); !done) return done.error();
  const WalkCounts& counts = walk.counts();
  out.chunks = counts.chunks;
  out.damaged_chunks = counts.damaged_chunks;
  out.bytes_lost = counts.skipped;
  std::ranges::move(walk.notes(), std::back_inserter(out.notes));
  std::ranges::move(bytes->notes(), std::back_inserter(out.notes));
  salvager.report(out);
  if (counts.is_closed && !*summary)
    out.notes.push_back({Severity::warning,
                         "the index at its end is missing or breaks off, which "
                         "costs no message"});
  out.was_whole = counts.is_closed && *summary &&
                  std::ranges::none_of(
                      out.notes, [](const Note& note) { return note.severity == Severity::bad; });
  return out;
}

Result<Recovery> salvage(std::unique_ptr<ByteSource> source,
                         const PutBytes& put,
                         const Progress& progress) {
  auto unwrapped = unwrap(std::move(source));
  if (!unwrapped) return unwrapped.error();
  auto bytes = random_bytes_of(std::move(unwrapped).value(), progress);
  if (!bytes) return bytes.error();
  return salvage(std::shared_ptr<const RandomBytes>(std::move(bytes).value()), put, progress);
}

}  // namespace

Result<Recovery> salvage(const std::string& path, const PutBytes& put, const Progress& progress) {
  auto file = open_file(path);
  if (!file) return file.error().at(path);
  auto saved = salvage(std::move(file).value(), put, progress);
  if (!saved && saved.error().code == Errc::corrupt) return saved.error().at(path);
  return saved;
}

Result<Recovery> salvage(std::span<const std::byte> bytes, const PutBytes& put) {
  return salvage(open_memory(bytes), put, {});
}

}  // namespace proofmass::io::mcap
