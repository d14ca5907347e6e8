#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"

// Log of how a recording was made: events at its source and its file.
namespace proofmass {

/// Events that are stored in the file and reported to observers.
enum class EventKind {
  lost,          ///< rows that the device or the protocol reports as missing
  overrun,       ///< rows that arrived while the queue to the disk was full
  gap,           ///< rows are missing according to the clocks, or none came for a while
  stalled,       ///< no data for longer than RecordOptions::stall_s
  disconnected,  ///< the source is lost
  reconnected,
  clock_jump,  ///< the device clock stepped, backwards or far ahead
  clock_dead,  ///< the device clock does not advance: time is counted instead
  host_jump,   ///< the host's time of day stepped relative to its steady clock
  disk_full,   ///< or another failure to write
  triggered,   ///< the level was crossed
  rotated,     ///< a new file begins
  note,        ///< a note of the source or of an analysis
};
/// "clock_jump"
[[nodiscard]] std::string_view name_of(EventKind kind);

struct RecordEvent {
  EventKind kind = EventKind::note;
  Severity severity = Severity::info;
  double time_s = 0.0;      ///< time on the recording's clock
  double duration_s = 0.0;  ///< length of a gap; 0 for other events
  std::uint64_t rows = 0;   ///< rows lost, as far as known
  std::string text;         ///< one sentence for the user
  std::vector<Advice> advice{};
};

/// Relation of the recording's clock to the host's: host = start + (1 + drift) t.
struct ClockMap {
  std::int64_t start_realtime_ns = 0;   ///< time of day (UTC, since 1970) of the first sample
  std::optional<Uncertain> rate_error;  ///< recording's clock; absent: recording too short
  std::optional<Uncertain> rate_hz;     ///< sample rate by the host's clock
};

/// Time from a block's arrival to its estimate.
struct Latency {
  std::size_t blocks = 0;
  double median_s = 0.0, p99_s = 0.0, worst_s = 0.0;
};

enum class RecordEnd {
  duration,     ///< as requested
  stopped,      ///< by the observer
  source_end,   ///< end of the file or stream
  source_gone,  ///< Errc::device
  disk_failed,
};

struct RecordSummary {
  std::vector<std::string> files;  ///< closed files, in order
  RecordEnd end = RecordEnd::stopped;
  std::string end_reason{};  ///< for source_gone and disk_failed: one line
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;         ///< known missing: device, protocol, overruns, clocks, disk
  std::uint64_t overrun = 0;      ///< part of `lost` due to a full queue
  std::uint64_t not_kept = 0;     ///< rows outside the trigger
  std::uint64_t not_written = 0;  ///< part of `lost` since the disk failed: rows in no file
  double duration_s = 0.0;
  std::vector<RecordEvent> gaps;  ///< lost, overrun and gap events: the first 10 000
  std::size_t gap_count = 0;
  std::vector<RecordEvent> events;  ///< all other events: the first 10 000
  ClockMap clock;
  std::optional<Latency> latency;  ///< present with an analysis
  std::optional<Recording> head;   ///< the file's header, without values
  std::vector<Note> audit;         ///< from signal::RunningAudit: jitter, clipping, stuck channels
};

/// What was recovered from an MCAP file that was not closed, and what is missing.
struct Recovery {
  std::string file;  ///< as written
  bool was_whole = false;
  std::uint64_t bytes_read = 0, bytes_lost = 0;
  std::uint64_t messages = 0, chunks = 0, damaged_chunks = 0;
  /// For recordings made by Proofmass: rows recovered, first and last time, and missing intervals
  /// between them.
  std::uint64_t samples = 0;
  double first_s = 0.0, last_s = 0.0;
  std::uint64_t missing_rows = 0;
  std::vector<Note> notes;  ///< what is missing, and where, one sentence each
};

}  // namespace proofmass
