#include "computing.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace py = pybind11;

namespace proofmass::python {
namespace {

/// Thrown within the computation to cancel it.
struct Cancelled {};

// State shared by the two threads.
class Shared {
 public:
  /// Called by the computing thread and its own worker threads.
  void report(std::string_view stage, double fraction) {
    if (cancelled_) throw Cancelled{};
    const std::lock_guard lock(mutex_);
    latest_ = {std::string(stage), fraction};
  }
  void finish() {
    const std::lock_guard lock(mutex_);
    finished_ = true;
    changed_.notify_one();
  }
  /// Waits for a limited time; true if the computation has finished.
  bool wait() {
    constexpr std::chrono::milliseconds look_again(50);
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, look_again, [&] { return finished_; });
  }
  [[nodiscard]] std::optional<std::pair<std::string, double>> take_latest() {
    const std::lock_guard lock(mutex_);
    return std::exchange(latest_, std::nullopt);
  }
  void cancel() { cancelled_ = true; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool finished_ = false;
  std::optional<std::pair<std::string, double>> latest_;
  std::atomic<bool> cancelled_ = false;
};

// Throws any exception raised by a signal handler or by the callable.
void look_up(Shared& shared, const py::object& progress) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress.is_none()) return;
  if (const auto latest = shared.take_latest()) progress(latest->first, latest->second);
}

}  // namespace

void compute(const py::object& progress, const std::function<void(const Progress&)>& work) {
  Shared shared;
  std::exception_ptr thrown;
  std::thread worker([&] {
    try {
      work([&](std::string_view stage, double fraction) { shared.report(stage, fraction); });
    } catch (...) {
      thrown = std::current_exception();
    }
    shared.finish();
  });
  std::exception_ptr raised;
  {
    const py::gil_scoped_release unlocked;
    while (!shared.wait()) {
      if (raised) continue;
      const py::gil_scoped_acquire locked;
      try {
        look_up(shared, progress);
      } catch (...) {
        raised = std::current_exception();
        shared.cancel();
      }
    }
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (thrown) std::rethrow_exception(thrown);
  look_up(shared, progress);
}

}  // namespace proofmass::python
