#include "proofmass/acquire/recorder/file.hpp"

#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <utility>

#include "proofmass/core/version.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::int64_t message_ns = 100'000'000;  ///< rows per message
constexpr std::int64_t chunk_ns = 400'000'000;  ///< maximum loss in a crash, plus the timer's delay
constexpr std::size_t message_bytes = std::size_t{64} << 10;

/// Host name and system.
void add_host(RecordWords& words) {
  utsname host{};
  if (::uname(&host) != 0) return;
  words["host"] = host.nodename;
  words["kernel"] = fmt::format("{} {} {}", host.sysname, host.release, host.machine);
}

RecordWords words_of(const RecordFileHead& head) {
  const Recording& recording = head.source.recording;
  RecordWords words = head.metadata;
  words["version"] = version();
  words["source"] = recording.source;
  words["source_format"] = recording.format;
  if (recording.time.rate_hz > 0.0) words["rate_hz"] = fmt::format("{}", recording.time.rate_hz);
  for (const auto& [name, value] : head.source.settings) words["setting " + name] = value;
  words["start_utc"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  add_host(words);
  return words;
}

Recording without_values(const Recording& recording) {
  Recording out = recording;
  for (Channel& channel : out.channels) channel.values.edit().clear();
  out.time.source = TimeSource::stamps;
  out.time.stamps_s.clear();
  return out;
}

}  // namespace

RecordFile::RecordFile(DiskWriter& disk, std::shared_ptr<PartFile> part, const RecordFileHead& head)
    : disk_(disk),
      part_(std::move(part)),
      mcap_({.is_self_contained = true}),
      head_(without_values(head.source.recording)),
      estimate_columns_(head.estimates),
      audit_(head_) {
  samples_.rows.channels.resize(head_.channels.size());
  estimates_.rows.channels.resize(estimate_columns_.size());
}

Result<std::unique_ptr<RecordFile>> RecordFile::create(DiskWriter& disk,
                                                       std::unique_ptr<PartFile> part,
                                                       const RecordFileHead& head) {
  std::unique_ptr<RecordFile> file(new RecordFile(disk, std::move(part), head));
  const std::string front = file->front(head);
  Status written = file->part_->append(front);
  if (written) written = file->part_->sync();
  if (!written) {
    file->part_->discard();
    return written.error();
  }
  file->front_ = {{}, file->mcap_.mark(), 0};
  disk.open(file->part_, file->front_);
  return file;
}

std::string RecordFile::front(const RecordFileHead& head) {
  mcap_.add_metadata("proofmass", words_of(head));
  const bool is_only = head.sensor_files.size() == 1;
  for (std::size_t k = 0; k < head.sensor_files.size(); ++k)
    mcap_.add_attachment(is_only ? "sensor.toml" : fmt::format("sensor.{}.toml", k + 1),
                         "application/toml", 0, head.sensor_files[k]);
  events_ = mcap_.add_json_topic("events", std::string(io::mcap::event_schema));
  clock_ = mcap_.add_json_topic("clock", std::string(io::mcap::clock_schema));
  return mcap_.take_bytes();
}

void RecordFile::begin(double origin_s, std::int64_t start_ns) {
  has_begun_ = true;
  origin_s_ = last_s_ = origin_s;
  start_ns_ = start_ns;
  samples_.topic = mcap_.add_samples_topic(
      {.name = "recording", .columns = head_.channels, .start_ns = start_ns});
  if (estimate_columns_.empty()) return;
  estimates_.topic = mcap_.add_samples_topic({.name = "estimates",
                                              .columns = estimate_columns_,
                                              .start_ns = start_ns,
                                              .derived_from = "recording"});
}

std::uint64_t RecordFile::log_ns(double time_s) const {
  return io::mcap::log_time_ns(start_ns_, time_s);
}

void RecordFile::add_rows(const Block& block) {
  if (block.rows() == 0) return;
  audit(block);
  append(samples_, block);
  rows_ += block.rows();
  last_s_ = block.stamps_s.back();
}

void RecordFile::add_estimates(const Block& rows) {
  if (rows.rows() > 0) append(estimates_, rows);
}

void RecordFile::append(Waiting& waiting, const Block& block) {
  Rows& rows = waiting.rows;
  if (rows.stamps_s.empty()) waiting.since_ns = host_now_ns();
  for (const double stamp_s : block.stamps_s) rows.stamps_s.push_back(stamp_s - origin_s_);
  for (std::size_t c = 0; c < rows.channels.size(); ++c)
    rows.channels[c].insert(rows.channels[c].end(), block.channels[c].begin(),
                            block.channels[c].end());
  if (8 * rows.rows() * (rows.channels.size() + 1) >= message_bytes) flush(waiting);
}

void RecordFile::flush(Waiting& waiting) {
  Rows& rows = waiting.rows;
  if (rows.rows() == 0) return;
  note_chunk();
  const std::vector<View<double>> columns(rows.channels.begin(), rows.channels.end());
  mcap_.add_samples(waiting.topic, waiting.written, log_ns(rows.stamps_s.front()), rows.stamps_s,
                    columns);
  waiting.written += rows.rows();
  rows.clear();
  pump();
}

void RecordFile::add_event(const RecordEvent& event, const HostTimes& now) {
  note_chunk();
  const std::uint64_t at_ns =
      has_begun_ ? log_ns(event.time_s - origin_s_) : static_cast<std::uint64_t>(now.realtime_ns);
  mcap_.add_json(events_, at_ns, json_of(event, origin_s_, now));
  pump();
}

void RecordFile::add_clock(double time_s, const HostTimes& arrived) {
  note_chunk();
  mcap_.add_json(clock_, log_ns(time_s - origin_s_), clock_json(time_s - origin_s_, arrived));
  pump();
}

void RecordFile::note_chunk() {
  if (!chunk_since_ns_) chunk_since_ns_ = host_now_ns();
}

void RecordFile::tick(std::int64_t now_ns) {
  for (Waiting* waiting : {&samples_, &estimates_})
    if (now_ns - waiting->since_ns >= message_ns) flush(*waiting);
  if (chunk_since_ns_ && now_ns - *chunk_since_ns_ >= chunk_ns) flush_chunk();
}

void RecordFile::flush_chunk() {
  flush(samples_);
  flush(estimates_);
  mcap_.close_chunk();
  pump();
}

/// Passes closed chunks to the disk.
void RecordFile::pump() {
  DiskPiece piece{mcap_.take_bytes(), {}, samples_.written};
  if (piece.bytes.empty()) return;
  chunk_since_ns_.reset();
  piece.mark = mcap_.mark();
  while (!disk_.put(piece))
    if (while_waiting) while_waiting();
}

void RecordFile::begin_stretch(const std::string& name) {
  if (!head_.labels.empty()) head_.labels.back().last = rows_ - 1;
  head_.labels.push_back({name, rows_, rows_});
  begins_stretch_ = rows_ > 0;
}

/// For the audit, the time between segments does not count.
void RecordFile::audit(const Block& block) {
  const double first_s = block.stamps_s.front();
  if (begins_stretch_) between_stretches_s_ += first_s - last_s_;
  begins_stretch_ = false;
  shifted_s_.clear();
  for (const double stamp_s : block.stamps_s)
    shifted_s_.push_back(stamp_s - origin_s_ - between_stretches_s_);
  Block shifted = block;
  shifted.first = rows_;
  shifted.stamps_s = shifted_s_;
  audit_.add(shifted);
}

void RecordFile::add_audit(RecordWords& summary) {
  if (!found_) found_ = audit_.finish(head_);
  const signal::RecordingAudit& found = *found_;
  summary["samples"] = std::to_string(rows_);
  summary["duration_s"] = fmt::format("{:.9g}", last_s_ - origin_s_);
  if (found.timing.jitter_s) summary["jitter_s"] = fmt::format("{:.3g}", *found.timing.jitter_s);
  for (const signal::ChannelAudit& channel : found.channels) {
    if (channel.clipped > 0) summary["clipped " + channel.name] = std::to_string(channel.clipped);
    if (channel.nonfinite > 0)
      summary["without a number " + channel.name] = std::to_string(channel.nonfinite);
  }
}

void RecordFile::add_ends(const RecordWords& summary) {
  if (!head_.labels.empty() && rows_ > 0) {
    head_.labels.back().last = rows_ - 1;
    head_.label_channel = "stretch";
    mcap_.add_labels(head_, log_ns(0.0));
  }
  mcap_.add_metadata("summary", summary);
  mcap_.finish();
}

void RecordFile::close(RecordWords summary) {
  if (!has_begun_) begin(0.0, host_times_now().realtime_ns);
  flush_chunk();
  add_audit(summary);
  add_ends(summary);
  pump();
  disk_.close();
}

Status RecordFile::close_after(const DiskWriter::Failure& failure,
                               const RecordEvent& event,
                               RecordWords summary) {
  // If another file of the recording failed, only the beginning of this one is written.
  const DiskPiece& kept = failure.file == part_ ? failure.kept : front_;
  add_audit(summary);
  rows_ = kept.rows;
  summary["samples"] = std::to_string(rows_);
  const std::uint64_t whole = kept.mark.bytes;
  if (const Status cut = part_->truncate(whole); !cut) return cut;
  mcap_.rewind(kept.mark);
  mcap_.add_json(events_, log_ns(event.time_s - origin_s_),
                 json_of(event, origin_s_, host_times_now()));
  head_.labels.clear();
  add_ends(summary);
  if (!part_->append(mcap_.take_bytes()))
    if (const Status cut = part_->truncate(whole); !cut) return cut;
  return part_->keep();
}

}  // namespace proofmass::acquire
