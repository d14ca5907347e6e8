#include "proofmass/core/in_parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace proofmass {
namespace {

// Combines the progress of several analyses into one mean.
class SharedProgress {
 public:
  SharedProgress(Progress shown, std::size_t parts) : shown_(std::move(shown)), done_(parts) {}

  Progress part(std::size_t k) {
    return [this, k](std::string_view, double fraction) {
      const std::scoped_lock lock(mutex_);
      done_[k] = fraction;
      double sum = 0.0;
      for (const double part : done_) sum += part;
      if (shown_) shown_("analysing", sum / static_cast<double>(done_.size()));
    };
  }

 private:
  std::mutex mutex_;
  Progress shown_;
  std::vector<double> done_;
};

}  // namespace

void in_parallel(std::size_t parts,
                 const Progress& shown,
                 const std::function<void(std::size_t, Progress)>& work) {
  SharedProgress shared(shown, parts);
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> troubles(parts);
  const auto take = [&] {
    for (std::size_t k = next++; k < parts; k = next++) {
      try {
        work(k, shared.part(k));
      } catch (...) {
        troubles[k] = std::current_exception();
      }
    }
  };
  {
    const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (std::size_t k = 1; k < std::min(processors, parts); ++k) others.emplace_back(take);
    take();
  }
  for (const std::exception_ptr& trouble : troubles) {
    if (trouble) std::rethrow_exception(trouble);
  }
}

void run_tasks(std::size_t samples, std::span<const std::function<void()>> tasks) {
  // Starting a thread takes as long as some ten thousand samples.
  constexpr std::size_t worth_threads = std::size_t{1} << 18;
  if (samples < worth_threads) {
    for (const std::function<void()>& task : tasks) task();
    return;
  }
  in_parallel(tasks.size(), {}, [&](std::size_t k, const Progress&) { tasks[k](); });
}

void run_tasks(std::size_t samples, std::initializer_list<std::function<void()>> tasks) {
  run_tasks(samples, std::span(tasks.begin(), tasks.size()));
}

}  // namespace proofmass
