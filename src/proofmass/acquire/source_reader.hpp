#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "proofmass/acquire/arrival_queue.hpp"
#include "proofmass/acquire/recorder.hpp"

namespace proofmass::acquire {

/// Reads a source on a thread of its own and never keeps it waiting, if it comes at its own pace:
/// what finds no room in the queue is dropped and counted. Says when nothing comes, and opens the
/// source again when it is gone.
class SourceReader {
 public:
  SourceReader(std::unique_ptr<Source> source,
               const OpenSource& open,
               const RecordOptions& options,
               ArrivalQueue& queue);
  SourceReader(const SourceReader&) = delete;
  SourceReader& operator=(const SourceReader&) = delete;
  ~SourceReader() { stop(); }

  /// Reads no more; what is in the queue stays there.
  void stop();
  /// Rows dropped behind the last that found room; once it is stopped.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  void run();
  [[nodiscard]] bool read_to_the_end();
  [[nodiscard]] bool reopen();
  void hand_on_rows(std::size_t channels);
  void count_on(Arrival& arrival);
  void hand_on(Incoming::Kind kind, std::string reason = {});
  void keep_notes();
  void watch_silence();
  [[nodiscard]] double stall_s() const;
  void pause(double seconds) const;

  std::unique_ptr<Source> source_;
  const OpenSource& open_;
  const RecordOptions& options_;
  ArrivalQueue& queue_;
  std::atomic<bool> stops_ = false;
  Incoming item_;
  std::uint64_t dropped_ = 0;  ///< rows since the last that found room
  std::vector<Note> dropped_notes_;
  std::int64_t rows_ns_ = 0;  ///< when the last rows came
  bool is_stalled_ = false;
  bool is_reopened_ = false;          ///< and no rows have come since
  std::optional<double> last_count_;  ///< of the device, at the row that came last
  std::string end_;                   ///< why the silence ends the reading
  std::thread thread_;
};

}  // namespace proofmass::acquire
