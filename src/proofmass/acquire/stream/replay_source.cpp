#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/acquire/stream/pacer.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/recording_stream.hpp"
#include "proofmass/io/write_recording.hpp"

namespace proofmass::acquire {
namespace {

using OpenedFile = std::variant<Recording, io::RecordingStream>;

/// Larger files are read in blocks, as `proofmass convert` does.
constexpr std::uint64_t most_bytes_in_memory = std::uint64_t{64} << 20;
/// Limit of a read if there is no pacing.
constexpr double most_rows_at_once = 4096.0;
constexpr double most_s_at_once = 0.1;

const Recording& recording_of(const OpenedFile& file) {
  if (const auto* whole = std::get_if<Recording>(&file)) return *whole;
  return std::get<io::RecordingStream>(file).head();
}

bool has_time(const OpenedFile& file) {
  const TimeBase& time = recording_of(file).time;
  if (time.rate_hz > 0.0 || !time.is_uniform()) return true;
  const auto* stream = std::get_if<io::RecordingStream>(&file);
  return stream != nullptr && stream->has_stamps();
}

/// A time of the recording in whole nanoseconds, the clock of the replayed device.
std::int64_t to_ns(double time_s) {
  constexpr double most_ns = 9e18;  // range of an int64
  if (std::isnan(time_s)) return 0;
  return std::llround(std::clamp(time_s * 1e9, -most_ns, most_ns));
}

class ReplaySource final : public Source {
 public:
  /// Without a speed it runs as fast as it is read.
  ReplaySource(OpenedFile file, SourceHead head, std::optional<double> speed)
      : file_(std::move(file)), head_(std::move(head)) {
    if (speed) pacer_.emplace(*speed);
    const double wanted = head_.recording.time.rate_hz * most_s_at_once * speed.value_or(1.0);
    most_rows_ = speed ? static_cast<std::size_t>(std::clamp(wanted, 1.0, most_rows_at_once))
                       : static_cast<std::size_t>(most_rows_at_once);
  }

  const SourceHead& head() const override { return head_; }

  Result<Arrived> read(Arrival& arrival, std::chrono::milliseconds patience) override {
    arrival.clear(head_.recording.channels.size());
    if (taken_ == block_.rows()) {
      auto next = next_block();
      if (!next) return next.error();
      block_ = std::move(next).value();
      taken_ = 0;
    }
    if (block_.rows() == 0) return end(arrival);
    if (pacer_ && !pacer_->wait_until(time_ns(taken_), patience)) return Arrived::nothing;
    hand_on(arrival);
    return Arrived::rows;
  }

 private:
  Result<Block> next_block() {
    if (auto* stream = std::get_if<io::RecordingStream>(&file_)) return stream->next();
    if (std::exchange(is_given_, true)) return Block{};
    return io::whole_of(std::get<Recording>(file_));
  }

  [[nodiscard]] std::int64_t time_ns(std::size_t row) const {
    return to_ns(block_.stamps_s.empty() ? recording_of(file_).time.at(block_.first + row)
                                         : block_.stamps_s[row]);
  }

  /// Passes on the rows that are due.
  void hand_on(Arrival& arrival) {
    const std::int64_t now_ns =
        pacer_ ? pacer_->now_ns() : std::numeric_limits<std::int64_t>::max();
    const std::size_t end = std::min(block_.rows(), taken_ + most_rows_);
    const std::size_t first = taken_;
    do arrival.device_ns.push_back(time_ns(taken_++));
    while (taken_ < end && time_ns(taken_) <= now_ns);
    for (std::size_t c = 0; c < arrival.channels.size(); ++c) {
      const auto rows = block_.channels[c].subspan(first, taken_ - first);
      arrival.channels[c].assign(rows.begin(), rows.end());
    }
    arrival.host_ns = host_now_ns();
  }

  /// Information known only at the end of the file comes first.
  Arrived end(Arrival& arrival) {
    if (std::exchange(is_end_reported_, true)) return Arrived::ended;
    const Recording& file = recording_of(file_);
    for (const Note& note : file.notes) {
      const auto is_same = [&](const Note& known) { return known.text == note.text; };
      if (std::ranges::none_of(head_.recording.notes, is_same)) arrival.notes.push_back(note);
    }
    if (!file.labels.empty())
      arrival.notes.push_back(
          {Severity::info,
           fmt::format("the labels of column {} are not replayed", file.label_channel)});
    return arrival.notes.empty() ? Arrived::ended : Arrived::nothing;
  }

  OpenedFile file_;
  SourceHead head_;
  std::optional<Pacer> pacer_;
  std::size_t most_rows_ = 1;
  Block block_;
  std::size_t taken_ = 0;  ///< rows of the block that were passed on
  bool is_given_ = false;
  bool is_end_reported_ = false;
};

/// nullopt: as fast as it is read.
Result<std::optional<double>> speed_of(SourceUri& uri) {
  if (uri.value("speed") == "max") return std::optional<double>();
  const auto speed = uri.number("speed", 0.0);
  if (!speed) return invalid(speed.error().message + ", or max");
  return std::optional(speed->value_or(1.0));
}

Status check_file(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (path.empty()) return invalid("expected a file, as in replay:run.csv");
  // If the file does not exist, reading reports it.
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status) ||
      std::filesystem::is_directory(status))
    return Done{};
  return invalid("is not a file: for a pipe or a device use stdin: or serial:");
}

SourceHead head_of(const SourceUri& uri, const Recording& file, std::optional<double> speed) {
  SourceHead head;
  head.recording.source = uri.text();
  head.recording.format = "replay";
  head.recording.notes = file.notes;
  const TimeBase& time = file.time;
  head.recording.time = {.source = time.source,
                         .channel = time.channel,
                         .rate_hz = time.rate_hz,
                         .stamps_s = {},
                         .start_ns = time.start_ns};
  for (const Channel& channel : file.channels)
    head.recording.channels.push_back({channel.name, channel.unit, {}});
  head.has_device_clock = true;
  // At another speed its clock does not follow the host's, which therefore cannot check it.
  head.is_paced = speed == 1.0;
  head.settings = {{"file", uri.place()},
                   {"file format", file.format},
                   {"speed", speed ? fmt::format("{:g}", *speed) : "max"}};
  return head;
}

}  // namespace

Result<std::unique_ptr<Source>> open_replay(SourceUri& uri, const OpenOptions& options) {
  const auto speed = speed_of(uri);
  if (!speed) return speed.error();
  const auto rate_hz = uri.number("rate", 0.0);
  if (!rate_hz) return rate_hz.error();
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  if (const Status is_file = check_file(uri.place()); !is_file) return is_file.error();
  auto opened = io::open_recording(uri.place(),
                                   {.rate_hz = *rate_hz, .duckdb_library = options.duckdb_library},
                                   most_bytes_in_memory);
  if (!opened) return opened.error();
  OpenedFile file = std::move(opened).value();
  if (!has_time(file)) return invalid("the file has no times: add rate=HZ");
  SourceHead head = head_of(uri, recording_of(file), *speed);
  return std::unique_ptr<Source>(
      std::make_unique<ReplaySource>(std::move(file), std::move(head), *speed));
}

}  // namespace proofmass::acquire
