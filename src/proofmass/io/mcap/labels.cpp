#include "proofmass/io/mcap/labels.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>

#include "proofmass/io/cell.hpp"

namespace proofmass::io::mcap {
namespace {

std::string quoted(std::string text) {
  std::ranges::replace(text, '"', '\'');
  std::ranges::replace_if(text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return '"' + text + '"';
}

/// Removes the field before the next comma from the front.
std::string_view next_field(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view field = line.substr(0, comma);
  line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  return field;
}

std::optional<std::size_t> sample_in(std::string_view field) {
  std::size_t sample = 0;
  const auto read = std::from_chars(field.data(), field.data() + field.size(), sample);
  const bool is_whole = read.ec == std::errc{} && read.ptr == field.data() + field.size();
  return is_whole ? std::optional(sample) : std::nullopt;
}

class LabelledReader final : public RecordingReader {
 public:
  LabelledReader(std::unique_ptr<RecordingReader> reader, std::shared_ptr<std::string> table)
      : reader_(std::move(reader)), table_(std::move(table)) {}

  [[nodiscard]] const RawHead& head() const override { return reader_->head(); }
  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    const Status read = reader_->next(most, rows);
    if (read && !rows.channels.empty()) samples_ += rows.channels.front().size();
    return read;
  }
  void finish(Recording& recording) override {
    reader_->finish(recording);
    add_labels(*table_, samples_, recording);
  }
  [[nodiscard]] double fraction_read() const override { return reader_->fraction_read(); }

 private:
  std::unique_ptr<RecordingReader> reader_;
  std::shared_ptr<std::string> table_;
  std::size_t samples_ = 0;
};

}  // namespace

std::string labels_table(const Recording& recording) {
  const std::string& channel = recording.label_channel;
  std::string out = fmt::format("first,last,{}\n", quoted(channel.empty() ? "label" : channel));
  for (const Label& label : recording.labels)
    out += fmt::format("{},{},{}\n", label.first, label.last, quoted(label.text));
  return out;
}

void add_labels(std::string_view table, std::size_t samples, Recording& recording) {
  if (table.empty() || !recording.labels.empty()) return;
  std::string channel;
  std::size_t unlabelled = 0;
  for (bool is_header = true; !table.empty(); is_header = false) {
    const std::size_t end = table.find('\n');
    std::string_view line = table.substr(0, end);
    table.remove_prefix(end == std::string_view::npos ? table.size() : end + 1);
    const auto first = sample_in(next_field(line));
    const auto last = sample_in(next_field(line));
    const std::string text(trimmed(line));
    if (is_header) channel = text.empty() ? "label" : text;
    if (!first || !last || text.empty() || *first < unlabelled || *last < *first ||
        *last >= samples)
      continue;
    unlabelled = *last + 1;
    recording.labels.push_back({text, *first, *last});
  }
  if (!recording.labels.empty()) recording.label_channel = channel;
}

std::unique_ptr<RecordingReader> with_labels(std::unique_ptr<RecordingReader> reader,
                                             std::shared_ptr<std::string> table) {
  return std::make_unique<LabelledReader>(std::move(reader), std::move(table));
}

}  // namespace proofmass::io::mcap
