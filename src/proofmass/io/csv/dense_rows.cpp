#include "proofmass/io/csv/dense_rows.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/reading/channel_units.hpp"

namespace proofmass::io {
namespace {

std::size_t rows_of(const RawRows& rows) {
  return rows.channels.empty() ? 0 : rows.channels.front().size();
}

/// Indices of the requested channels.
std::vector<std::size_t> wanted_channels(const RawHead& head, const ReadOptions& options) {
  std::vector<std::size_t> wanted;
  const auto& channels = head.recording.channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const bool named = std::ranges::any_of(options.channels, [&](const std::string& n) {
      return lower(n) == lower(channels[c].name);
    });
    const bool meant =
        channels[c].unit.quantity == Quantity::acceleration ||
        (channels[c].unit.quantity == Quantity::unknown && is_accelerometer_name(channels[c].name));
    if (options.channels.empty() ? meant : named) wanted.push_back(c);
  }
  return wanted;
}

bool has_figure(const RawRows& rows, const std::vector<std::size_t>& channels, std::size_t row) {
  return std::ranges::any_of(channels,
                             [&](std::size_t c) { return !std::isnan(rows.channels[c][row]); });
}

std::vector<std::size_t> others_than(const std::vector<std::size_t>& wanted, std::size_t channels) {
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < channels; ++c)
    if (std::ranges::find(wanted, c) == wanted.end()) others.push_back(c);
  return others;
}

/// Adds the channels that are sampled together with the requested ones: in at least a quarter of
/// their rows.
void add_companions(const RawRows& rows,
                    const std::vector<std::size_t>& wanted,
                    std::vector<std::size_t>& kept) {
  for (const std::size_t c : others_than(wanted, rows.channels.size())) {
    std::size_t mine = 0;
    std::size_t both = 0;
    for (std::size_t r = 0; r < rows_of(rows); ++r) {
      if (!has_figure(rows, wanted, r)) continue;
      ++mine;
      if (!std::isnan(rows.channels[c][r])) ++both;
    }
    if (4 * both >= mine) kept.push_back(c);
  }
  std::ranges::sort(kept);
}

/// True if the requested and the other channels have separate rows: few rows have both.
bool take_turns(const RawRows& rows,
                const std::vector<std::size_t>& wanted,
                const std::vector<std::size_t>& others) {
  std::size_t mine = 0;
  std::size_t theirs = 0;
  std::size_t both = 0;
  for (std::size_t r = 0; r < rows_of(rows); ++r) {
    const bool is_mine = has_figure(rows, wanted, r);
    const bool is_theirs = has_figure(rows, others, r);
    mine += is_mine ? 1 : 0;
    theirs += is_theirs ? 1 : 0;
    both += is_mine && is_theirs ? 1 : 0;
  }
  constexpr std::size_t few = 4;  // samples of two sensors that share a stamp by chance
  return mine > few && theirs > few && both * few < std::min(mine, theirs);
}

/// The median interval of the stamps of the rows with a value; 0 if it cannot be determined.
double median_step(const RawRows& rows, const std::vector<std::size_t>& wanted) {
  std::vector<double> steps;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t r = 0; r < rows.stamps.size(); ++r) {
    if (!has_figure(rows, wanted, r)) continue;
    if (const double step = rows.stamps[r] - last; step > 0.0) steps.push_back(step);
    last = rows.stamps[r];
  }
  return median(steps).value_or(0.0);
}

class OneSensor final : public RecordingReader {
 public:
  OneSensor(std::unique_ptr<RecordingReader> reader,
            std::vector<std::size_t> wanted,
            std::vector<std::size_t> kept,
            double closest)
      : reader_(std::move(reader)),
        head_(reader_->head()),
        wanted_(std::move(wanted)),
        kept_(std::move(kept)),
        closest_(closest) {
    std::string left_out;
    for (const std::size_t c : others_than(kept_, head_.recording.channels.size()))
      left_out += (left_out.empty() ? "" : ", ") + head_.recording.channels[c].name;
    left_out_ = left_out.substr(0, 200);
    std::vector<Channel> channels;
    for (const std::size_t c : kept_) channels.push_back(head_.recording.channels[c]);
    head_.recording.channels = std::move(channels);
    head_.rows.reset();
    head_.rate_hz.reset();
  }

  [[nodiscard]] const RawHead& head() const override { return head_; }
  [[nodiscard]] double fraction_read() const override { return reader_->fraction_read(); }

  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    rows.channels.assign(kept_.size(), {});
    rows.stamps.clear();
    while (rows_of(rows) < most) {
      if (const Status read = reader_->next(most - rows_of(rows), ahead_); !read) return read;
      if (head_.stamps) head_.stamps->origin = reader_->head().stamps->origin;
      for (std::size_t r = 0; r < rows_of(ahead_); ++r) take_row(r, rows);
      if (rows_of(ahead_) > 0) continue;
      if (has_open_) put_open(rows);
      break;
    }
    return Done{};
  }

  void finish(Recording& recording) override {
    reader_->finish(recording);
    // Rows no longer match lines, nor labels.
    recording.first_line = 0;
    recording.labels.clear();
    recording.label_channel.clear();
    recording.notes.push_back(
        {Severity::info,
         fmt::format("several sensors with rows of their own: {} rows without a figure of these "
                     "channels are left out, and with them {}: choose another channel to read it",
                     others_, left_out_),
         {Advice{"channel"}}});
    if (joined_ > 0)
      recording.notes.push_back(
          {Severity::info,
           fmt::format("{} readings whose channels fell on two stamps are put together", joined_)});
  }

 private:
  /// Adds the row to the pending sample, or completes that and begins another.
  void take_row(std::size_t r, RawRows& rows) {
    if (!has_figure(ahead_, wanted_, r)) {
      ++others_;
      return;
    }
    if (has_open_ && belongs(r)) {
      for (std::size_t k = 0; k < kept_.size(); ++k)
        if (std::isnan(open_[k])) open_[k] = ahead_.channels[kept_[k]][r];
      ++joined_;
      return;
    }
    if (has_open_) put_open(rows);
    has_open_ = true;
    open_.clear();
    for (const std::size_t c : kept_) open_.push_back(ahead_.channels[c][r]);
    if (!ahead_.stamps.empty()) open_stamp_ = ahead_.stamps[r];
  }
  /// True if the row has only values that the pending sample lacks, at almost the same time.
  [[nodiscard]] bool belongs(std::size_t r) const {
    if (ahead_.stamps.empty() || !(ahead_.stamps[r] - open_stamp_ <= closest_)) return false;
    for (std::size_t k = 0; k < kept_.size(); ++k)
      if (!std::isnan(open_[k]) && !std::isnan(ahead_.channels[kept_[k]][r])) return false;
    return true;
  }
  void put_open(RawRows& rows) {
    for (std::size_t k = 0; k < kept_.size(); ++k) rows.channels[k].push_back(open_[k]);
    if (head_.stamps) rows.stamps.push_back(open_stamp_);
    has_open_ = false;
  }

  std::unique_ptr<RecordingReader> reader_;
  RawHead head_;
  RawRows ahead_;
  std::vector<std::size_t> wanted_;  ///< channels that define the rows
  std::vector<std::size_t> kept_;    ///< these, and those sampled with them
  double closest_;                   ///< closer stamps belong to one sample
  std::string left_out_;
  std::vector<double> open_;  ///< the sample to which the next row may belong
  double open_stamp_ = 0.0;
  bool has_open_ = false;
  std::size_t others_ = 0;
  std::size_t joined_ = 0;
};

}  // namespace

std::unique_ptr<RecordingReader> rows_of_one_sensor(std::unique_ptr<RecordingReader> reader,
                                                    const RawRows& first,
                                                    const ReadOptions& options) {
  const RawHead& head = reader->head();
  auto wanted = wanted_channels(head, options);
  const std::size_t channels = head.recording.channels.size();
  if (!head.stamps || wanted.empty() || first.channels.size() != channels) return reader;
  std::vector<std::size_t> kept = wanted;
  add_companions(first, wanted, kept);
  const auto others = others_than(kept, channels);
  if (others.empty() || !take_turns(first, wanted, others)) return reader;
  const double closest = 0.25 * median_step(first, wanted);
  return std::make_unique<OneSensor>(std::move(reader), std::move(wanted), std::move(kept),
                                     closest);
}

}  // namespace proofmass::io
