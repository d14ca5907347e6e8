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

/// What an analysis made of one block of samples.
struct Analysed {
  Rows estimates{};  ///< there may be none
  std::vector<Note> notes{};
  double time_s = 0.0;                    ///< of the last sample it has had
  std::optional<std::int64_t> host_ns{};  ///< when that arrived; absent of what comes at the end
  std::optional<Error> failure{};         ///< it is the last then
};

/// Runs an analysis on a thread of its own, so that one that takes long holds nobody up: so many
/// bytes of samples wait for it at most, and of estimates for whoever takes them. put() and what
/// follows it are called by one thread.
class AnalysisThread {
 public:
  /// tell: called on the analysis's thread whenever there is something to take.
  AnalysisThread(std::unique_ptr<LiveAnalysis> analysis,
                 std::size_t most_bytes,
                 std::function<void()> tell);
  AnalysisThread(const AnalysisThread&) = delete;
  AnalysisThread& operator=(const AnalysisThread&) = delete;
  /// Waits for the block that is worked on; the others are forgotten.
  ~AnalysisThread();

  /// False: there is no room for this block; there is none either until half of what waits is done.
  [[nodiscard]] bool put(const Block& samples, std::int64_t host_ns);
  /// What was made of the next block in place of an old one; false: nothing within the patience, or
  /// nothing is on its way.
  [[nodiscard]] bool take(Analysed& out, std::chrono::milliseconds patience);
  /// No sample follows: once what waits is done, the analysis finishes.
  void finish();
  /// Forgets the samples that wait; how many rows.
  std::size_t forget_waiting();

  /// Nothing waits, is worked on or is to be taken.
  [[nodiscard]] bool is_idle() const;
  /// Idle for good: it has finished or failed.
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
  const std::function<void()> tell_;
  double time_s_ = 0.0;  ///< of the last sample; the thread's alone

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  std::deque<Analysed> made_;
  std::vector<Task> spare_tasks_;
  std::vector<Analysed> spare_made_;
  std::size_t task_bytes_ = 0, made_bytes_ = 0;
  bool is_full_ = false;  ///< and not half empty again yet
  bool is_busy_ = false;
  bool finishes_ = false;
  bool is_over_ = false;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace proofmass::acquire
