#include "proofmass/serve/job_queue.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace proofmass::serve {
namespace {

using Clock = std::chrono::steady_clock;

struct Job {
  ChildCommand command;
  JobUrgency urgency = JobUrgency::asked;
  JobStatus status{};
  Clock::time_point begun{};
  std::atomic<bool> cancelled = false;
};

double seconds_since(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

}  // namespace

bool take_progress(std::string_view line, JobStatus& status) {
  constexpr std::string_view word = "progress ";
  if (!line.starts_with(word)) return false;
  line.remove_prefix(word.size());
  double percent = 0.0;
  const auto [stop, failed] = std::from_chars(line.data(), line.data() + line.size(), percent);
  if (failed != std::errc()) return false;
  status.fraction = std::clamp(percent / 100.0, 0.0, 1.0);
  line.remove_prefix(static_cast<std::size_t>(stop - line.data()));
  status.stage = line.starts_with(' ') ? std::string(line.substr(1)) : std::string();
  return true;
}

struct JobQueue::State {
  std::shared_ptr<Job> next() {
    for (const JobUrgency urgency : {JobUrgency::asked, JobUrgency::background})
      for (auto& [id, job] : jobs)
        if (job->status.state == JobState::waiting && job->urgency == urgency) return job;
    return nullptr;
  }
  void work() {
    std::unique_lock lock(mutex);
    while (!ends) {
      const std::shared_ptr<Job> job = next();
      if (!job) {
        changed.wait(lock);
        continue;
      }
      job->status.state = JobState::running;
      job->begun = Clock::now();
      lock.unlock();
      run(*job);
      lock.lock();
    }
  }
  void run(Job& job) {
    auto child = ChildProcess::start(job.command);
    if (!child) {
      const std::lock_guard lock(mutex);
      job.status.messages.push_back(child.error().message);
      job.status.state = JobState::failed;
      return;
    }
    ChildProcess running = std::move(child).value();
    const ChildEnd end = running.follow([&](std::string_view line) { take(job, line); },
                                        [&] { return job.cancelled || ends; });
    const std::lock_guard lock(mutex);
    job.status.end = end;
    job.status.seconds = seconds_since(job.begun);
    // What has ended before it could be stopped is done.
    const bool good = end.signal == 0 && end.status == 0;
    job.status.state = good            ? JobState::done
                       : job.cancelled ? JobState::cancelled
                                       : JobState::failed;
  }
  void take(Job& job, std::string_view line) {
    constexpr std::size_t most_messages = 200;
    const std::lock_guard lock(mutex);
    if (take_progress(line, job.status)) return;
    if (job.status.messages.size() < most_messages) job.status.messages.emplace_back(line);
  }

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::map<std::uint64_t, std::shared_ptr<Job>> jobs;
  std::uint64_t last = 0;
  std::atomic<bool> ends = false;
  std::vector<std::thread> workers;
};

JobQueue::JobQueue(std::size_t at_a_time) : state_(std::make_unique<State>()) {
  for (std::size_t k = 0; k < at_a_time; ++k)
    state_->workers.emplace_back([state = state_.get()] { state->work(); });
}

JobQueue::~JobQueue() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
  }
  state_->changed.notify_all();
  for (std::thread& worker : state_->workers) worker.join();
}

std::uint64_t JobQueue::add(ChildCommand command, JobUrgency urgency) {
  auto job = std::make_shared<Job>();
  job->command = std::move(command);
  job->urgency = urgency;
  const std::lock_guard lock(state_->mutex);
  state_->jobs.emplace(++state_->last, std::move(job));
  state_->changed.notify_one();
  return state_->last;
}

std::optional<JobStatus> JobQueue::status(std::uint64_t id) const {
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->jobs.find(id);
  if (found == state_->jobs.end()) return std::nullopt;
  JobStatus status = found->second->status;
  if (status.state == JobState::running) status.seconds = seconds_since(found->second->begun);
  return status;
}

void JobQueue::cancel(std::uint64_t id) {
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->jobs.find(id);
  if (found == state_->jobs.end()) return;
  found->second->cancelled = true;
  JobState& state = found->second->status.state;
  if (state == JobState::waiting) state = JobState::cancelled;
}

void JobQueue::hurry(std::uint64_t id) {
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->jobs.find(id);
  if (found != state_->jobs.end()) found->second->urgency = JobUrgency::asked;
}

void JobQueue::forget(std::uint64_t id) {
  cancel(id);
  const std::lock_guard lock(state_->mutex);
  state_->jobs.erase(id);
}

}  // namespace proofmass::serve
