#include <algorithm>
#include <fmt/format.h>

#include "proofmass/acquire/recorder/session.hpp"

// End of a recording.
namespace proofmass::acquire {

void RecordSession::close() {
  RecordSummary& summary = tally_.summary;
  if (const std::uint64_t dropped = reader_->dropped(); dropped > 0)
    report({EventKind::overrun, Severity::warning, line_->last_s(), 0.0, dropped,
            fmt::format("{} rows were dropped at the end, as the queue was full", dropped)});
  finish_analysis();
  tally_.report_clock();
  if (gate_) summary.not_kept = gate_->not_kept();
  summary.latency = latency_.latency();
  summary.head = head_.recording;
  summary.head->time.source = TimeSource::stamps;
  summary.head->time.start_ns = start_ns_;
  close_file();
  summary.end = *end_;
  for (const Closed& closed : closed_) {
    summary.samples += closed.rows;
    if (!closed.path.empty()) summary.files.push_back(closed.path);
  }
  const std::uint64_t kept = rows_ - summary.not_kept;
  summary.not_written = kept - std::min(kept, summary.samples);
  summary.lost += summary.not_written;
}

void RecordSession::close_file() {
  if (file_ && !disk_.failure()) {
    file_->close(tally_.words());
    add_closed();
  }
  disk_.drain();
  if (const auto failure = disk_.failure()) close_failed(*failure);
}

/// Closes the data on the disk as completely as possible.
void RecordSession::close_failed(const DiskWriter::Failure& failure) {
  RecordSummary& summary = tally_.summary;
  end_ = RecordEnd::disk_failed;
  summary.end_reason = failure.error.message;
  forget_unwritten(failure);
  if (!file_ || failure.is_naming) return;
  const RecordEvent event{EventKind::disk_full, Severity::bad, line_->last_s(), 0.0, 0,
                          summary.end_reason};
  (void)tally_.add(event);
  if (watch_.event) watch_.event(event);
  const Status closed = file_->close_after(failure, event, tally_.words());
  add_closed();
  if (closed) return;
  summary.end_reason += "; " + closed.error().message;
  closed_.back().path.clear();
}

/// Files that were passed on but are not on the disk. The data of a failed file stay in its part.
void RecordSession::forget_unwritten(const DiskWriter::Failure& failure) {
  const auto failed =
      std::ranges::find(closed_, failure.file, [](const Closed& closed) { return closed.part; });
  for (auto closed = failed; closed != closed_.end(); ++closed) {
    const bool is_whole = closed == failed && failure.is_naming;
    if (!is_whole) closed->rows = closed == failed ? failure.kept.rows : 0;
    closed->path.clear();
  }
  // The last one can still be closed.
  const bool is_last = !closed_.empty() && file_ && closed_.back().part == file_->part();
  if (is_last && !failure.is_naming) closed_.pop_back();
}

}  // namespace proofmass::acquire
