#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"

// How a recording was made: what its source and its file went through.
namespace proofmass {

/// What is told of a recording's course, in its file and to whoever listens.
enum class EventKind {
  lost,          ///< rows that the device or the protocol knows to be missing
  overrun,       ///< rows that came while the queue to the disk was full
  gap,           ///< the clocks say that rows are missing, or that none came for a while
  stalled,       ///< nothing has come for longer than RecordOptions::stall_s
  disconnected,  ///< the source is gone
  reconnected,
  clock_jump,  ///< the device's clock stepped, back or far ahead
  clock_dead,  ///< the device's clock does not move: time is counted instead
  host_jump,   ///< the host's time of day stepped against its steady clock
  disk_full,   ///< or another failure to write
  triggered,   ///< the level was passed
  rotated,     ///< a new file begins
  note,        ///< what the source or an analysis had to say
};
/// "clock_jump"
[[nodiscard]] std::string_view name_of(EventKind kind);

struct RecordEvent {
  EventKind kind = EventKind::note;
  Severity severity = Severity::info;
  double time_s = 0.0;      ///< on the recording's clock
  double duration_s = 0.0;  ///< of a gap; of others 0
  std::uint64_t rows = 0;   ///< lost, as far as it is known
  std::string text;         ///< one sentence for a person
};

/// How the recording's clock runs against the host's: host = start + (1 + drift) t.
struct ClockMap {
  std::int64_t start_realtime_ns = 0;   ///< time of day (UTC, since 1970) of the first sample
  std::optional<Uncertain> rate_error;  ///< of the recording's clock; absent: too short to tell
  std::optional<Uncertain> rate_hz;     ///< of the samples, by the host's clock
};

/// How long it took from a block's arrival to its estimate.
struct Latency {
  std::size_t blocks = 0;
  double median_s = 0.0, p99_s = 0.0, worst_s = 0.0;
};

enum class RecordEnd {
  duration,     ///< as asked
  stopped,      ///< by the watcher
  source_end,   ///< a file's or stream's end
  source_gone,  ///< Errc::device
  disk_failed,
};

struct RecordSummary {
  std::vector<std::string> files;  ///< closed, in their order
  RecordEnd end = RecordEnd::stopped;
  std::string end_reason{};  ///< of source_gone and disk_failed: one line
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;         ///< known missing: device, protocol, overruns, clocks, the disk
  std::uint64_t overrun = 0;      ///< of these, for want of room in the queue
  std::uint64_t not_kept = 0;     ///< rows that the trigger did not ask for
  std::uint64_t not_written = 0;  ///< of these, since the disk failed: rows that no file has
  double duration_s = 0.0;
  std::vector<RecordEvent> gaps;  ///< lost, overrun and gap events: the first 10 000
  std::size_t gap_count = 0;
  std::vector<RecordEvent> events;  ///< all others: the first 10 000
  ClockMap clock;
  std::optional<Latency> latency;  ///< with an analysis
  std::optional<Recording> head;   ///< as the file's, without values
  std::vector<Note> audit;         ///< of signal::RunningAudit: jitter, clipping, stuck channels
};

/// What was saved from an MCAP file that was not closed, and what was not.
struct Recovery {
  std::string file;  ///< as written
  bool was_whole = false;
  std::uint64_t bytes_read = 0, bytes_lost = 0;
  std::uint64_t messages = 0, chunks = 0, damaged_chunks = 0;
  /// Of our own recordings: rows saved, the first and last time, and stretches between that are
  /// missing.
  std::uint64_t samples = 0;
  double first_s = 0.0, last_s = 0.0;
  std::uint64_t missing_rows = 0;
  std::vector<Note> notes;  ///< what is missing, and where, each a sentence
};

}  // namespace proofmass
