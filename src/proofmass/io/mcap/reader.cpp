#include "proofmass/io/mcap/reader.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <set>
#include <tuple>

#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/mcap/catalogue.hpp"
#include "proofmass/io/mcap/decoder.hpp"
#include "proofmass/io/mcap/labels.hpp"
#include "proofmass/io/mcap/recording.hpp"
#include "proofmass/io/mcap/samples.hpp"
#include "proofmass/io/mcap/table.hpp"
#include "proofmass/io/reading/recording_reader.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {
namespace {

Schema schema_of(const Catalogue& catalogue, const ChannelRecord& channel) {
  const auto found = catalogue.schemas.find(channel.schema);
  return found == catalogue.schemas.end() ? Schema{} : found->second;
}

std::uint64_t messages_of(const Catalogue& catalogue, std::uint16_t channel) {
  const auto found = catalogue.messages.find(channel);
  return found == catalogue.messages.end() ? 0 : found->second;
}

/// Rows of a topic, if the file can hold that many.
std::optional<std::uint64_t> rows_of(const Topic& topic,
                                     std::uint64_t messages,
                                     std::uint64_t file_bytes) {
  if (messages == 0) return std::nullopt;
  std::uint64_t a_message = 1;
  if (topic.channel.encoding == samples_encoding) {
    const auto block = read_samples_head(topic.first.data);
    if (!block) return std::nullopt;
    a_message = block->rows;
  }
  constexpr std::uint64_t least_bytes_a_row = 4;
  std::uint64_t rows = 0;
  if (__builtin_mul_overflow(messages, a_message, &rows) || rows > file_bytes / least_bytes_a_row)
    return std::nullopt;
  return rows;
}

/// The topics of a file, and the reasons why others are not read.
struct Topics {
  std::vector<TableSpec> read;
  std::set<std::uint16_t> events;
  std::vector<Note> others;
};

/// The metadata topics of our own recordings are not tables.
bool is_beside(const Topic& topic) {
  return topic.schema.name == event_schema || topic.schema.name == clock_schema;
}

Topics topics_of(const Catalogue& catalogue, std::uint64_t file_bytes) {
  Topics out;
  // Several publishers of a topic have separate channels.
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known;
  std::vector<std::uint64_t> messages;
  constexpr std::size_t most_topics = 1024;
  std::size_t too_many = 0;
  for (const auto& [id, first] : catalogue.firsts) {
    const ChannelRecord& channel = catalogue.channels.at(id);
    Topic topic{channel, schema_of(catalogue, channel), first};
    if (topic.schema.name == event_schema) out.events.insert(id);
    if (is_beside(topic)) continue;
    const auto key = std::tuple(channel.topic, channel.encoding, topic.schema.data);
    const auto [place, is_new] = known.try_emplace(key, out.read.size());
    if (is_new && out.read.size() == most_topics) {
      known.erase(place);
      ++too_many;
      continue;
    }
    if (is_new) {
      out.read.push_back(
          {.topic = std::move(topic), .channels = {}, .rows = std::nullopt, .notes = {}});
      messages.push_back(0);
    }
    out.read[place->second].channels.insert(id);
    messages[place->second] += messages_of(catalogue, id);
  }
  std::vector<TableSpec> kept;
  for (std::size_t i = 0; i < out.read.size(); ++i) {
    TableSpec& spec = out.read[i];
    const auto decoder = decoder_of(spec.topic);
    if (!decoder) {
      constexpr std::size_t most_listed = 8;
      if (out.others.size() < most_listed)
        out.others.push_back(
            {Severity::info,
             fmt::format("{} messages of topic {} are not read: they are {}", messages[i],
                         shown(spec.topic.channel.topic), decoder.error().message)});
      continue;
    }
    spec.rows = rows_of(spec.topic, messages[i], file_bytes);
    spec.rows_are_guessed = messages[i] > 1 && spec.topic.channel.encoding == samples_encoding;
    kept.push_back(std::move(spec));
  }
  out.read = std::move(kept);
  if (too_many > 0)
    out.others.push_back({Severity::warning, fmt::format("{} topics beyond the first {} are not "
                                                         "looked at",
                                                         too_many, most_topics)});
  return out;
}

TableSummary summary_of(const TableSpec& spec) {
  const Map& metadata = spec.topic.channel.metadata;
  TableSummary out{.name = spec.topic.channel.topic,
                   .headings = {},
                   .rows = spec.rows,
                   .rate_hz = std::nullopt,
                   .rows_are_guessed = spec.rows_are_guessed,
                   .is_derived = metadata.contains("derived_from")};
  if (const auto decoder = decoder_of(spec.topic)) {
    out.headings = (*decoder)->head().headings;
    out.rate_hz = (*decoder)->head().rate_hz;
  }
  return out;
}

class File final : public TableFile {
 public:
  File(std::shared_ptr<const RandomBytes> bytes, std::vector<TableSpec> specs, WalkHints hints)
      : bytes_(std::move(bytes)), specs_(std::move(specs)), hints_(std::move(hints)) {
    for (const TableSpec& spec : specs_) tables_.push_back(summary_of(spec));
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return tables_; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t table,
                                                              const ReadOptions& options) override {
    TableSpec spec = specs_[table];
    spec.labels = std::make_shared<std::string>();
    auto reader = open_table(bytes_, spec, hints_);
    if (!reader) return reader.error();
    auto recording = recording_reader_of(std::move(reader).value(), options);
    if (!recording || spec.topic.channel.encoding != samples_encoding) return recording;
    return with_labels(std::move(recording).value(), spec.labels);
  }

 private:
  std::shared_ptr<const RandomBytes> bytes_;
  std::vector<TableSpec> specs_;
  WalkHints hints_;
  std::vector<TableSummary> tables_;
};

Error nothing_read(const Catalogue& catalogue, const std::vector<Note>& others) {
  if (!catalogue.damage.empty())
    return {Errc::corrupt, catalogue.damage.front().text + "; no message is before it"};
  if (!others.empty())
    return {Errc::unsupported, "no topic can be read: " + others.front().text +
                                   "; expected proofmass-samples, cdr with ros2msg, or json"};
  return {Errc::too_few_samples, "is an MCAP file without a message"};
}

std::string writer_of(const Catalogue& catalogue) {
  std::string words = fmt::format(
      "written by {}", catalogue.library.empty() ? "an unnamed program" : shown(catalogue.library));
  if (!catalogue.profile.empty()) words += fmt::format(", profile {}", shown(catalogue.profile));
  return words;
}

}  // namespace

bool claims(std::string_view head, std::string_view) {
  return head.starts_with(magic.substr(0, 5));
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  const auto head = source->peek(magic.size());
  if (!head) return head.error();
  if (*head != magic)
    return Error{Errc::corrupt, "byte 5: not version 0 of MCAP, or its first line is damaged"};
  auto opened = random_bytes_of(std::move(source), options.progress);
  if (!opened) return opened.error();
  const std::shared_ptr<const RandomBytes> bytes = std::move(opened).value();
  const auto catalogue = read_catalogue(bytes);
  if (!catalogue) return catalogue.error();
  Topics topics = topics_of(*catalogue, bytes->size());
  if (topics.read.empty()) return nothing_read(*catalogue, topics.others);
  const auto known = std::make_shared<std::set<std::uint16_t>>();
  for (const auto& [channel, first] : catalogue->firsts) known->insert(channel);
  for (TableSpec& spec : topics.read) {
    spec.known = known;
    spec.events = topics.events;
    spec.notes = catalogue->notes;
    spec.notes.push_back({Severity::info, writer_of(*catalogue)});
    spec.notes.insert(spec.notes.end(), topics.others.begin(), topics.others.end());
    if (spec.channels.size() > 1)
      spec.notes.push_back(
          {Severity::info, fmt::format("topic {} comes from {} publishers: "
                                       "their messages follow one another",
                                       shown(spec.topic.channel.topic), spec.channels.size())});
  }
  return std::unique_ptr<TableFile>(
      std::make_unique<File>(bytes, std::move(topics.read), catalogue->hints));
}

}  // namespace proofmass::io::mcap
