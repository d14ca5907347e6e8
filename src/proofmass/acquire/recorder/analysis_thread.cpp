#include "proofmass/acquire/recorder/analysis_thread.hpp"

#include <utility>

namespace proofmass::acquire {
namespace {

constexpr std::size_t most_spare_blocks = 8;

std::size_t bytes_for(std::size_t rows, std::size_t columns) {
  return sizeof(Rows) + sizeof(double) * rows * (columns + 1);
}

std::size_t bytes_of(const Rows& rows) {
  return bytes_for(rows.rows(), rows.channels.size());
}

/// Copies the block, reusing the memory of `out`.
void copy(const Block& block, Rows& out) {
  out.stamps_s.assign(block.stamps_s.begin(), block.stamps_s.end());
  out.channels.resize(block.channels.size());
  for (std::size_t c = 0; c < block.channels.size(); ++c)
    out.channels[c].assign(block.channels[c].begin(), block.channels[c].end());
}

}  // namespace

AnalysisThread::AnalysisThread(std::unique_ptr<LiveAnalysis> analysis,
                               std::size_t most_bytes,
                               std::function<void()> report)
    : analysis_(std::move(analysis)), most_bytes_(most_bytes), report_(std::move(report)) {
  thread_ = std::thread([this] { run(); });
}

AnalysisThread::~AnalysisThread() {
  {
    const std::scoped_lock lock(mutex_);
    stops_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

AnalysisThread::Task AnalysisThread::spare_task() {
  if (spare_tasks_.empty()) return {};
  Task task = std::move(spare_tasks_.back());
  spare_tasks_.pop_back();
  return task;
}

bool AnalysisThread::put(const Block& samples, std::int64_t host_ns) {
  const std::scoped_lock lock(mutex_);
  const std::size_t bytes = bytes_for(samples.rows(), samples.channels.size());
  if (is_full_ && task_bytes_ > most_bytes_ / 2) return false;
  is_full_ = !tasks_.empty() && task_bytes_ + bytes > most_bytes_;
  if (is_full_) return false;
  Task task = spare_task();
  copy(samples, task.samples);
  task.first = samples.first;
  task.host_ns = host_ns;
  task_bytes_ += bytes;
  tasks_.push_back(std::move(task));
  changed_.notify_all();
  return true;
}

bool AnalysisThread::take(Analysed& out, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] {
    const bool will_come = is_busy_ || !tasks_.empty() || (finishes_ && !is_over_);
    return !made_.empty() || !will_come;
  });
  if (made_.empty()) return false;
  if (spare_made_.size() < most_spare_blocks) spare_made_.push_back(std::move(out));
  out = std::move(made_.front());
  made_.pop_front();
  made_bytes_ -= bytes_of(out.estimates);
  changed_.notify_all();
  return true;
}

void AnalysisThread::finish() {
  const std::scoped_lock lock(mutex_);
  finishes_ = true;
  changed_.notify_all();
}

std::size_t AnalysisThread::forget_waiting() {
  const std::scoped_lock lock(mutex_);
  std::size_t rows = 0;
  for (const Task& task : tasks_) rows += task.samples.rows();
  tasks_.clear();
  task_bytes_ = 0;
  return rows;
}

bool AnalysisThread::is_idle() const {
  const std::scoped_lock lock(mutex_);
  return tasks_.empty() && made_.empty() && !is_busy_;
}

bool AnalysisThread::is_done() const {
  const std::scoped_lock lock(mutex_);
  return is_over_ && made_.empty();
}

/// False: no task will come, and nothing remains to be finished.
bool AnalysisThread::wait_for_task(std::unique_lock<std::mutex>& lock) {
  const auto has_room = [&] { return made_.empty() || made_bytes_ <= most_bytes_; };
  changed_.wait(lock, [&] { return stops_ || (has_room() && (finishes_ || !tasks_.empty())); });
  return !stops_;
}

void AnalysisThread::run() {
  std::unique_lock lock(mutex_);
  bool goes_on = true;
  while (goes_on && wait_for_task(lock)) {
    std::optional<Task> task;
    if (!tasks_.empty()) {
      task = std::move(tasks_.front());
      tasks_.pop_front();
      task_bytes_ -= bytes_of(task->samples);
    }
    Analysed out;
    if (!spare_made_.empty()) {
      out = std::move(spare_made_.back());
      spare_made_.pop_back();
    }
    is_busy_ = true;
    lock.unlock();
    goes_on = work(task ? &*task : nullptr, out);
    lock.lock();
    if (task && spare_tasks_.size() < most_spare_blocks) spare_tasks_.push_back(std::move(*task));
    is_over_ = !goes_on;
    hand_back(out, lock);
  }
}

/// Without a task, finishes the analysis. False: there will be no further result.
bool AnalysisThread::work(const Task* task, Analysed& out) {
  out.estimates.clear();
  out.estimates.channels.resize(analysis_->columns().size());
  if (task != nullptr && !task->samples.stamps_s.empty()) time_s_ = task->samples.stamps_s.back();
  const Status made = task != nullptr
                          ? analysis_->add(view_of(task->samples, task->first), out.estimates)
                          : analysis_->finish(out.estimates);
  out.notes = analysis_->take_notes();
  out.time_s = time_s_;
  out.host_ns = task != nullptr ? std::optional(task->host_ns) : std::nullopt;
  out.failure = made ? std::nullopt : std::optional(made.error());
  return task != nullptr && made;
}

void AnalysisThread::hand_back(Analysed& out, std::unique_lock<std::mutex>& lock) {
  is_busy_ = false;
  const bool says_something = out.estimates.rows() > 0 || !out.notes.empty() || out.failure;
  if (says_something) {
    made_bytes_ += bytes_of(out.estimates);
    made_.push_back(std::move(out));
  } else if (spare_made_.size() < most_spare_blocks) {
    spare_made_.push_back(std::move(out));
  }
  if (is_over_) {
    tasks_.clear();
    task_bytes_ = 0;
  }
  changed_.notify_all();
  if (!says_something && !is_over_) return;
  lock.unlock();
  report_();
  lock.lock();
}

}  // namespace proofmass::acquire
