#include "proofmass/io/mcap/table.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/mcap/events.hpp"
#include "proofmass/io/mcap/labels.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::mcap {
namespace {

/// Use of a channel's messages.
enum class Use : unsigned char { unknown, known, event, read };

/// Text of a metadata record for a note: its short texts.
std::string words_of(const Metadata& metadata) {
  constexpr std::size_t longest = 300;
  std::string words = fmt::format("metadata \"{}\":", shown(metadata.name));
  for (const auto& [key, value] : metadata.values) {
    words += fmt::format(" {} = {};", shown(key), shown(value));
    if (words.size() > longest) return words + " …";
  }
  words.pop_back();
  return words;
}

class Table final : public TableReader {
 public:
  Table(std::shared_ptr<const RandomBytes> bytes,
        TableSpec spec,
        WalkHints hints,
        std::unique_ptr<Decoder> decoder)
      : bytes_(std::move(bytes)),
        channels_(),
        walk_(bytes_, std::move(hints)),
        decoder_(std::move(decoder)),
        labels_(spec.labels),
        head_(decoder_->head()) {
    for (const std::uint16_t channel : *spec.known) channels_[channel] = Use::known;
    for (const std::uint16_t channel : spec.events) channels_[channel] = Use::event;
    for (const std::uint16_t channel : spec.channels) channels_[channel] = Use::read;
    head_.rows = spec.rows;
    std::ranges::move(spec.notes, std::back_inserter(head_.notes));
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] double fraction_read() const override { return walk_.fraction_read(); }

  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    const std::size_t most = into.front().size();
    std::size_t filled = 0;
    while (filled < most) {
      if (next_ == rows_) {
        const auto taken = advance();
        if (!taken) return taken.error();
        if (!*taken) break;
      }
      const std::size_t count = std::min(rows_ - next_, most - filled);
      decoder_->copy(next_, count, into, filled);
      next_ += count;
      filled += count;
    }
    return filled;
  }

  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes = walk_.notes();
    std::ranges::move(bytes_->notes(), std::back_inserter(notes));
    std::ranges::move(decoder_->notes(), std::back_inserter(notes));
    if (refused_ > 0)
      notes.push_back(
          {Severity::bad, fmt::format("{} skipped, the first at byte {}: it {}",
                                      refused_ == 1 ? std::string("a message is")
                                                    : fmt::format("{} messages are", refused_),
                                      refused_at_, refusal_)});
    if (strange_ > 0)
      notes.push_back(
          {Severity::warning,
           fmt::format("{} messages are not looked at, as they are of channels that the "
                       "summary counts no message of, or the file has no record of",
                       strange_)});
    if (const auto events = events_.note()) notes.push_back(*events);
    notes.insert(notes.end(), beside_.begin(), beside_.end());
    return notes;
  }

 private:
  /// Advances to the next message with rows; false at the end.
  [[nodiscard]] Result<bool> advance() {
    Record record;
    for (;;) {
      const auto found = walk_.next(record);
      if (!found) return found.error();
      if (!*found) return false;
      if (record.op != Op::message) {
        report(record);
        continue;
      }
      const auto message = parse_message(record.content);
      if (!message) {
        refuse(record, "is shorter than a message is");
        continue;
      }
      const Use use = channels_[message->channel];
      strange_ += use == Use::unknown ? 1 : 0;
      if (use == Use::event) events_.add(*message);
      if (use != Use::read) continue;
      const auto rows = decoder_->take(*message, walk_.lost_bytes());
      if (!rows) refuse(record, rows.error().message);
      rows_ = rows ? *rows : 0;
      next_ = 0;
      if (rows_ > 0) return true;
    }
  }

  void refuse(const Record& record, const std::string& why) {
    if (refused_++ > 0) return;
    refused_at_ = record.offset;
    refusal_ = why;
  }

  /// Notes on other records.
  void report(const Record& record) {
    constexpr std::size_t most_listed = 8;
    if (record.op == Op::attachment) take_attachment(record.content);
    if (record.op != Op::metadata || beside_.size() >= most_listed) return;
    const auto metadata = parse_metadata(record.content);
    if (metadata && !metadata->values.empty())
      beside_.push_back({Severity::info, words_of(*metadata)});
  }

  void take_attachment(std::string_view content) {
    const auto head = parse_attachment_head(content);
    if (!head) return;
    constexpr std::size_t most_listed = 8;
    const auto data = attachment_data(content, *head);
    // A record larger than the limit is held only in part.
    const bool is_cut = content.size() < head->head_bytes + head->bytes;
    const bool is_damaged = !data && !is_cut;
    const bool are_labels = head->name == labels_name && labels_ && labels_->empty();
    if (are_labels && data) {
      *labels_ = *data;
    } else if (beside_.size() < most_listed) {
      beside_.push_back({is_damaged ? Severity::warning : Severity::info,
                         fmt::format("attached: \"{}\", {} bytes{}", shown(head->name), head->bytes,
                                     is_damaged ? ", damaged (its checksum is wrong)" : "")});
    }
  }

  std::shared_ptr<const RandomBytes> bytes_;
  std::array<Use, 65'536> channels_;
  Walk walk_;
  std::unique_ptr<Decoder> decoder_;
  std::shared_ptr<std::string> labels_;
  TableHead head_;
  std::size_t rows_ = 0;       ///< in the message
  std::size_t next_ = 0;       ///< the next of them
  std::uint64_t strange_ = 0;  ///< messages of unknown channels
  std::uint64_t refused_ = 0;
  std::uint64_t refused_at_ = 0;
  std::string refusal_;
  Events events_;
  std::vector<Note> beside_;
};

}  // namespace

Result<std::unique_ptr<TableReader>> open_table(std::shared_ptr<const RandomBytes> bytes,
                                                TableSpec spec,
                                                WalkHints hints) {
  auto decoder = decoder_of(spec.topic);
  if (!decoder) return decoder.error();
  return std::unique_ptr<TableReader>(std::make_unique<Table>(
      std::move(bytes), std::move(spec), std::move(hints), std::move(decoder).value()));
}

}  // namespace proofmass::io::mcap
