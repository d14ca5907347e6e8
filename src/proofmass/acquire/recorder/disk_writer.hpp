#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "proofmass/acquire/recorder/part_file.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/mcap/recording.hpp"

namespace proofmass::acquire {

/// Whole records of a file, and the file's contents once they are written.
struct DiskPiece {
  std::string bytes{};
  io::mcap::Mark mark{};
  std::uint64_t rows = 0;  ///< sample rows in the file by then
};

/// Writes on its own thread, so that a slow disk delays nobody as long as few pieces are queued.
/// After a failure nothing more is written.
class DiskWriter {
 public:
  struct Failure {
    Error error;
    std::shared_ptr<PartFile> file;
    DiskPiece kept;          ///< the last piece of that file that is complete, without its bytes
    bool is_naming = false;  ///< everything is written, but the file was not renamed
  };

  DiskWriter(std::size_t most_bytes, double sync_s);
  DiskWriter(const DiskWriter&) = delete;
  DiskWriter& operator=(const DiskWriter&) = delete;
  /// Writes the queued pieces.
  ~DiskWriter();

  /// Opens a file that already holds `kept`.
  void open(std::shared_ptr<PartFile> file, DiskPiece kept);
  /// Appends to the file opened last; false, after a timeout, if there is no room.
  [[nodiscard]] bool put(DiskPiece& piece);
  /// Renames the file once everything is written.
  void close();
  /// Waits until everything is done.
  void drain();
  [[nodiscard]] std::optional<Failure> failure() const;

 private:
  struct Task {
    std::shared_ptr<PartFile> file;  ///< the file from here on
    DiskPiece piece{};
    bool is_end = false;
  };
  void run();
  void wait_for_task(std::unique_lock<std::mutex>& lock);
  void sync_if_due(std::unique_lock<std::mutex>& lock);
  [[nodiscard]] Status work(Task& task);
  [[nodiscard]] bool is_sync_due() const;

  const std::size_t most_bytes_;
  const std::int64_t sync_ns_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  std::size_t waiting_bytes_ = 0;
  bool is_busy_ = false;
  bool stops_ = false;
  std::optional<Failure> failure_;
  // Used by the thread alone:
  std::shared_ptr<PartFile> file_;
  DiskPiece kept_;
  std::optional<std::int64_t> dirty_since_ns_;
  std::thread thread_;
};

}  // namespace proofmass::acquire
