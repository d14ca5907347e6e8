#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/rows.hpp"

namespace proofmass::acquire {

/// Result of an analysis for one block of samples.
struct Analysed {
  Rows estimates{};  ///< may be empty
  std::vector<Note> notes{};
  double time_s = 0.0;                    ///< time of the last sample processed
  std::optional<std::int64_t> host_ns{};  ///< arrival of that sample; absent for rows at the end
  std::optional<Error> failure{};         ///< no more results follow
};

/// Runs an analysis on its own thread, so that a slow one does not delay the recording. The queues
/// for samples and for estimates are limited in bytes. put() and the methods after it are called by
/// one thread.
class AnalysisThread {
 public:
  /// report: called on the analysis's thread whenever a result is available.
  AnalysisThread(std::unique_ptr<LiveAnalysis> analysis,
                 std::size_t most_bytes,
                 std::function<void()> report);
  AnalysisThread(const AnalysisThread&) = delete;
  AnalysisThread& operator=(const AnalysisThread&) = delete;
  /// Waits for the block in progress; the others are discarded.
  ~AnalysisThread();

  /// False: no room for this block, and none until half of the queue is processed.
  [[nodiscard]] bool put(const Block& samples, std::int64_t host_ns);
  /// Swaps in the result of the next block; false: none within the patience, or none pending.
  [[nodiscard]] bool take(Analysed& out, std::chrono::milliseconds patience);
  /// Ends the input: once the queue is processed, the analysis finishes.
  void finish();
  /// Discards the queued samples; returns their number of rows.
  std::size_t forget_waiting();

  /// True if nothing is queued, in progress or ready to take.
  [[nodiscard]] bool is_idle() const;
  /// True if idle for good: finished or failed.
  [[nodiscard]] bool is_done() const;

 private:
  struct Task {
    Rows samples{};
    std::size_t first = 0;
    std::int64_t host_ns = 0;
  };
  void run();
  [[nodiscard]] bool wait_for_task(std::unique_lock<std::mutex>& lock);
  [[nodiscard]] bool work(const Task* task, Analysed& out);
  void hand_back(Analysed& out, std::unique_lock<std::mutex>& lock);
  [[nodiscard]] Task spare_task();

  const std::unique_ptr<LiveAnalysis> analysis_;
  const std::size_t most_bytes_;
  const std::function<void()> report_;
  double time_s_ = 0.0;  ///< time of the last sample; used by the thread alone

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  std::deque<Analysed> made_;
  std::vector<Task> spare_tasks_;
  std::vector<Analysed> spare_made_;
  std::size_t task_bytes_ = 0, made_bytes_ = 0;
  bool is_full_ = false;  ///< set until the queue is half empty again
  bool is_busy_ = false;
  bool finishes_ = false;
  bool is_over_ = false;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace proofmass::acquire
