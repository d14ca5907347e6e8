#include "proofmass/io/layouts/hinted_reader.hpp"

#include <algorithm>

#include "proofmass/io/names.hpp"
#include "proofmass/io/time/stamp_shift.hpp"

namespace proofmass::io {
namespace {

bool is_axis(std::string_view name) {
  const std::string bare = bare_name(name);
  return bare.size() == 1 && bare[0] >= 'x' && bare[0] <= 'z';
}

class HintedReader final : public RecordingReader {
 public:
  HintedReader(std::unique_ptr<RecordingReader> reader, const MemberHint& hint)
      : reader_(std::move(reader)), zero_ns_(hint.zero_ns), head_(reader_->head()) {
    Recording& recording = head_.recording;
    recording.notes.insert(recording.notes.end(), hint.notes.begin(), hint.notes.end());
    auto& channels = recording.channels;
    const auto unwanted = std::ranges::find(channels, hint.left_out, &Channel::name);
    if (!hint.left_out.empty() && unwanted != channels.end() && channels.size() > 1) {
      left_out_ = static_cast<std::size_t>(unwanted - channels.begin());
      channels.erase(unwanted);
    }
    for (Channel& channel : channels) {
      ColumnLabel label = with_hint(ColumnLabel{channel.name, channel.unit}, hint);
      channel.name = std::move(label.name);
      channel.unit = std::move(label.unit);
    }
    if (!head_.stamps && !head_.rate_hz) head_.rate_hz = hint.rate_hz;
    move_origin();
  }

  [[nodiscard]] const RawHead& head() const override { return head_; }
  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    if (const Status read = reader_->next(most, rows); !read) return read;
    if (left_out_ && *left_out_ < rows.channels.size())
      rows.channels.erase(rows.channels.begin() + static_cast<std::ptrdiff_t>(*left_out_));
    move_origin();
    return Done{};
  }
  void finish(Recording& recording) override { reader_->finish(recording); }
  [[nodiscard]] double fraction_read() const override { return reader_->fraction_read(); }

 private:
  void move_origin() {
    if (!head_.stamps || !reader_->head().stamps) return;
    head_.stamps->origin = reader_->head().stamps->origin;
    const Unit& unit = head_.stamps->unit;
    if (zero_ns_ && unit.quantity == Quantity::time && unit.to_si == 1.0)
      head_.stamps->origin = moved(head_.stamps->origin, *zero_ns_);
  }

  std::unique_ptr<RecordingReader> reader_;
  std::optional<std::int64_t> zero_ns_;
  std::optional<std::size_t> left_out_;  ///< channel of the reader
  RawHead head_;
};

}  // namespace

ColumnLabel with_hint(ColumnLabel label, const MemberHint& hint) {
  if (!is_axis(label.name)) return label;
  if (label.unit.quantity == Quantity::unknown && !hint.unit.empty())
    label.unit = parse_unit(hint.unit).value_or(Unit{});
  if (!hint.sensor.empty()) label.name = hint.sensor + " " + label.name;
  return label;
}

std::unique_ptr<RecordingReader> with_hint(std::unique_ptr<RecordingReader> reader,
                                           const MemberHint& hint) {
  return std::make_unique<HintedReader>(std::move(reader), hint);
}

}  // namespace proofmass::io
