#include "proofmass/io/arrays/recording.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace proofmass::io {
namespace {

/// Columns in memory: returned as a whole, or in blocks.
class LoadedReader final : public RecordingReader {
 public:
  LoadedReader(RawHead head, RawRows rows) : head_(std::move(head)), rows_(std::move(rows)) {}

  [[nodiscard]] const RawHead& head() const override { return head_; }
  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    const std::size_t left = *head_.rows - at_;
    if (at_ == 0 && most >= left) {
      rows = std::exchange(rows_, {});
      rows_.channels.resize(rows.channels.size());
    } else {
      const std::size_t count = std::min(most, left);
      rows.channels.resize(rows_.channels.size());
      for (std::size_t c = 0; c < rows_.channels.size(); ++c)
        copy(rows_.channels[c], count, rows.channels[c]);
      if (head_.stamps) copy(rows_.stamps, count, rows.stamps);
      at_ += count;
      return Done{};
    }
    at_ = *head_.rows;
    return Done{};
  }
  void finish(Recording&) override {}
  [[nodiscard]] double fraction_read() const override { return 1.0; }

 private:
  void copy(const std::vector<double>& from, std::size_t count, std::vector<double>& to) const {
    const auto part = View<double>(from).subspan(std::min(at_, from.size()));
    to.assign(part.begin(),
              part.begin() + static_cast<std::ptrdiff_t>(std::min(count, part.size())));
  }

  RawHead head_;
  RawRows rows_;
  std::size_t at_ = 0;
};

/// Shifts the origin of stamps in seconds, which is exact to a nanosecond, to the start of the
/// clock.
void begin_at(std::int64_t start_ns, StampColumn& stamps) {
  if (stamps.origin.exponent10 == -9 && stamps.unit == *parse_unit("s"))
    stamps.origin.mantissa += start_ns;
}

}  // namespace

Result<std::unique_ptr<RecordingReader>> recording_reader_of(ArrayColumns columns,
                                                             Recording recording,
                                                             const ReadOptions& options) {
  const std::size_t count = columns.values.size();
  if (count == 0) return Error{Errc::too_few_samples, "has no column of numbers"};
  auto named = name_columns(columns.headings, count, ascends(columns.values[0]), options);
  if (!named) return named.error();
  NamedColumns names = std::move(named).value();
  RawHead head;
  head.rows = columns.values[0].size();
  head.rate_hz = columns.rate_hz;
  head.start_ns = columns.start_ns;
  head.recording = std::move(recording);
  std::ranges::move(names.notes, std::back_inserter(head.recording.notes));
  RawRows rows;
  for (std::size_t c = 0; c < count; ++c) {
    const ColumnLabel& label = names.labels[c];
    if (names.time != c) {
      head.recording.channels.push_back({label.name, label.unit, {}});
      rows.channels.push_back(std::move(columns.values[c]));
      continue;
    }
    rows.stamps = std::move(columns.values[c]);
    head.stamps = StampColumn{label.name, label.unit, {}, {}, !names.are_made_up};
    const auto origin = origin_of(rows.stamps);
    if (!origin) continue;
    head.stamps->origin = *origin;
    for (double& stamp : rows.stamps) stamp -= origin->value();
    if (columns.start_ns) begin_at(*columns.start_ns, *head.stamps);
  }
  return std::unique_ptr<RecordingReader>(
      std::make_unique<LoadedReader>(std::move(head), std::move(rows)));
}

}  // namespace proofmass::io
