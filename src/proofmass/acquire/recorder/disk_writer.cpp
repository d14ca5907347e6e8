#include "proofmass/acquire/recorder/disk_writer.hpp"

#include <chrono>
#include <utility>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

DiskWriter::DiskWriter(std::size_t most_bytes, double sync_s)
    : most_bytes_(most_bytes), sync_ns_(static_cast<std::int64_t>(sync_s * 1e9)) {
  thread_ = std::thread([this] { run(); });
}

DiskWriter::~DiskWriter() {
  {
    const std::scoped_lock lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DiskWriter::open(std::shared_ptr<PartFile> file, DiskPiece kept) {
  const std::scoped_lock lock(mutex_);
  tasks_.push_back({std::move(file), std::move(kept), false});
  changed_.notify_all();
}

bool DiskWriter::put(DiskPiece& piece) {
  std::unique_lock lock(mutex_);
  const bool has_room = changed_.wait_for(lock, std::chrono::milliseconds(50), [&] {
    return failure_ || waiting_bytes_ == 0 || waiting_bytes_ + piece.bytes.size() <= most_bytes_;
  });
  if (!has_room) return false;
  waiting_bytes_ += piece.bytes.size();
  tasks_.push_back({nullptr, std::move(piece), false});
  changed_.notify_all();
  return true;
}

void DiskWriter::close() {
  const std::scoped_lock lock(mutex_);
  tasks_.push_back({nullptr, {}, true});
  changed_.notify_all();
}

void DiskWriter::drain() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return tasks_.empty() && !is_busy_; });
}

std::optional<DiskWriter::Failure> DiskWriter::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

void DiskWriter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wait_for_task(lock);
    sync_if_due(lock);
    if (tasks_.empty() && stops_) return;
    if (tasks_.empty()) continue;
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    const std::size_t bytes = task.piece.bytes.size();
    is_busy_ = true;
    const bool works = !failure_;
    const bool is_naming = task.is_end;
    lock.unlock();
    const Status done = works ? work(task) : Status(Done{});
    lock.lock();
    is_busy_ = false;
    waiting_bytes_ -= bytes;
    if (!done) failure_ = Failure{done.error(), file_, kept_, is_naming};
    changed_.notify_all();
  }
}

void DiskWriter::wait_for_task(std::unique_lock<std::mutex>& lock) {
  const auto is_due = [&] { return stops_ || !tasks_.empty(); };
  if (!dirty_since_ns_) {
    changed_.wait(lock, is_due);
    return;
  }
  const std::int64_t left_ns = sync_ns_ - (host_now_ns() - *dirty_since_ns_);
  changed_.wait_for(lock, std::chrono::nanoseconds(left_ns), is_due);
}

void DiskWriter::sync_if_due(std::unique_lock<std::mutex>& lock) {
  if (!dirty_since_ns_ || host_now_ns() - *dirty_since_ns_ < sync_ns_ || failure_) return;
  dirty_since_ns_.reset();
  is_busy_ = true;
  lock.unlock();
  const Status synced = file_->sync();
  lock.lock();
  is_busy_ = false;
  if (!synced) failure_ = Failure{synced.error(), file_, kept_, false};
  changed_.notify_all();
}

Status DiskWriter::work(Task& task) {
  if (task.file) {
    file_ = std::move(task.file);
    kept_ = std::move(task.piece);
    return Done{};
  }
  if (task.is_end) {
    dirty_since_ns_.reset();
    return file_->keep();
  }
  if (const Status appended = file_->append(task.piece.bytes); !appended) return appended;
  if (!dirty_since_ns_) dirty_since_ns_ = host_now_ns();
  task.piece.bytes.clear();
  kept_ = std::move(task.piece);
  return Done{};
}

}  // namespace proofmass::acquire
