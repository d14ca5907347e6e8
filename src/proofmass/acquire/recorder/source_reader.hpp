#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "proofmass/acquire/recorder.hpp"
#include "proofmass/acquire/recorder/arrival_queue.hpp"

namespace proofmass::acquire {

/// Reads a source on its own thread. If the source has its own pace it is never kept waiting: rows
/// that find no room in the queue are dropped and counted. Reports silence, and reopens a source
/// that was lost.
class SourceReader {
 public:
  SourceReader(std::unique_ptr<Source> source,
               const OpenSource& open,
               const RecordOptions& options,
               ArrivalQueue& queue);
  SourceReader(const SourceReader&) = delete;
  SourceReader& operator=(const SourceReader&) = delete;
  ~SourceReader() { stop(); }

  /// Stops reading; the queue keeps its contents.
  void stop();
  /// Rows dropped after the last that found room; valid once stopped.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  void run();
  [[nodiscard]] bool read_to_the_end();
  [[nodiscard]] bool reopen();
  void hand_on_rows(std::size_t channels);
  void count_on(Arrival& arrival);
  void hand_on(QueueItem::Kind kind, std::string reason = {});
  void keep_notes();
  void watch_silence();
  [[nodiscard]] double stall_s() const;
  void pause(double seconds) const;

  std::unique_ptr<Source> source_;
  const OpenSource& open_;
  const RecordOptions& options_;
  ArrivalQueue& queue_;
  std::atomic<bool> stops_ = false;
  QueueItem item_;
  std::uint64_t dropped_ = 0;  ///< rows since the last that found room
  std::vector<Note> dropped_notes_;
  std::int64_t rows_ns_ = 0;  ///< arrival of the last rows
  bool is_stalled_ = false;
  bool is_reopened_ = false;          ///< and no rows have arrived since
  std::optional<double> last_count_;  ///< the device's count at the last row
  std::string end_;                   ///< reason if a silence ends the source
  std::thread thread_;
};

}  // namespace proofmass::acquire
