#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "proofmass/core/version.hpp"
#include "proofmass/io/mcap/recording.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace proofmass::io::mcap {
namespace {

/// Rows per message: 64 KiB, but at most one second.
std::size_t rows_a_message(const WriterHead& head) {
  constexpr std::size_t bytes = std::size_t{64} << 10;
  const std::size_t columns = head.recording.channels.size() + (head.has_stamps ? 1 : 0);
  const std::size_t fitting = std::max<std::size_t>(1, bytes / (8 * columns));
  const double rate_hz = head.recording.time.rate_hz;
  if (!(rate_hz > 0.0)) return fitting;
  return std::min(fitting, static_cast<std::size_t>(std::clamp(rate_hz, 1.0, 1e9)));
}

class Writer final : public RecordingWriter {
 public:
  Writer(std::unique_ptr<OutputFile> file, const WriterHead& head, const WriteOptions& options)
      : file_(std::move(file)),
        start_ns_(head.recording.time.start_ns.value_or(0)),
        rate_hz_(head.recording.time.rate_hz),
        has_stamps_(head.has_stamps),
        rows_a_message_(rows_a_message(head)),
        columns_(head.recording.channels.size() + (head.has_stamps ? 1 : 0)) {
    for (std::vector<double>& column : columns_) column.reserve(rows_a_message_);
    std::map<std::string, std::string> settings(options.metadata.begin(), options.metadata.end());
    settings["version"] = version();
    settings["source"] = head.recording.source;
    settings["source_format"] = head.recording.format;
    mcap_.add_metadata("proofmass", settings);
    if (!options.sensor_file.empty())
      mcap_.add_attachment("sensor.toml", "application/toml", log_ns(0, 0.0), options.sensor_file);
    const TimeBase& time = head.recording.time;
    SamplesTopic topic{.name = "recording",
                       .columns = head.recording.channels,
                       .has_stamps = head.has_stamps,
                       .start_ns = time.start_ns};
    if (!head.has_stamps && time.rate_hz > 0.0) topic.rate_hz = time.rate_hz;
    topic_ = mcap_.add_samples_topic(topic);
  }

  [[nodiscard]] Status write(const Block& block) override {
    const std::size_t rows = block.rows();
    for (std::size_t row = 0; row < rows;) {
      const std::size_t count = std::min(rows - row, rows_a_message_ - columns_.back().size());
      std::size_t c = 0;
      const auto append = [&](View<double> values) {
        const auto part = values.subspan(row, count);
        columns_[c].insert(columns_[c].end(), part.begin(), part.end());
        ++c;
      };
      if (has_stamps_) append(block.stamps_s);
      for (const View<double> values : block.channels) append(values);
      row += count;
      if (columns_.back().size() < rows_a_message_) continue;
      if (const Status flushed = flush(); !flushed) return flushed;
    }
    return Done{};
  }

  [[nodiscard]] Status finish(const Recording& recording) override {
    if (const Status flushed = flush(); !flushed) return flushed;
    if (!recording.labels.empty()) mcap_.add_labels(recording, log_ns(0, 0.0));
    mcap_.finish();
    if (const Status put = put_bytes(); !put) return put;
    return file_->keep();
  }

 private:
  [[nodiscard]] std::uint64_t log_ns(std::uint64_t sample, double stamp_s) const {
    if (has_stamps_) return log_time_ns(start_ns_, stamp_s);
    return log_time_ns(start_ns_, rate_hz_ > 0.0 ? static_cast<double>(sample) / rate_hz_ : 0.0);
  }

  [[nodiscard]] Status flush() {
    const std::size_t rows = columns_.back().size();
    if (rows == 0) return Done{};
    std::vector<View<double>> channels(columns_.begin() + (has_stamps_ ? 1 : 0), columns_.end());
    const View<double> stamps = has_stamps_ ? View<double>(columns_.front()) : View<double>();
    mcap_.add_samples(topic_, written_, log_ns(written_, has_stamps_ ? stamps.front() : 0.0),
                      stamps, channels);
    written_ += rows;
    for (std::vector<double>& column : columns_) column.clear();
    return put_bytes();
  }

  [[nodiscard]] Status put_bytes() { return file_->append(mcap_.take_bytes()); }

  std::unique_ptr<OutputFile> file_;
  RecordingEncoder mcap_;
  std::int64_t start_ns_;
  double rate_hz_;
  bool has_stamps_;
  std::size_t rows_a_message_;
  RecordingEncoder::Topic topic_ = 0;
  std::vector<std::vector<double>> columns_;  ///< columns of the next message; the stamps first
  std::uint64_t written_ = 0;
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create(std::unique_ptr<OutputFile> file,
                                                const WriterHead& head,
                                                const WriteOptions& options) {
  if (head.recording.channels.empty())
    return Error{Errc::too_few_samples, "there is no channel to write"};
  constexpr std::size_t most_channels = 0xFFFF;
  if (head.recording.channels.size() > most_channels)
    return Error{Errc::unsupported, "has more channels than a block of samples counts (65535)"};
  return std::unique_ptr<RecordingWriter>(std::make_unique<Writer>(std::move(file), head, options));
}

}  // namespace proofmass::io::mcap
