#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "proofmass/acquire/recorder/overrun_queue.hpp"
#include "proofmass/acquire/source.hpp"

struct iio_buffer;

namespace proofmass::acquire {

struct IioRequest {
  std::string uri{}, device{}, trigger{};  // libiio's own URI; names are empty if not given
  std::optional<double> rate_hz{};
  std::vector<std::string> channels{};
  std::optional<std::size_t> buffer_rows{};
  std::chrono::milliseconds patience{};
};

/// State shared by the thread that calls libiio and the one that reads the source. Everything
/// except the queue is protected by the lock.
struct IioWorker {
  std::mutex lock{};
  std::condition_variable changed{};
  std::string waits_for{};  ///< pending reply of the board: "an answer"; restarts the timeout
  std::size_t steps = 0;    ///< completed so far
  double slack_s = 0.0;     ///< added to the patience if the rate is low
  std::optional<Result<SourceHead>> opened{};
  std::unique_ptr<OverrunQueue> queue{};  ///< set with `opened`, constant afterwards
  iio_buffer* buffer = nullptr;           ///< while it may be cancelled
  bool is_stopped = false;                ///< the reader has stopped
  bool has_ended = false;                 ///< the thread has released libiio
};

/// Opens the board, reports to the line, and passes on the data until it is stopped or the board
/// fails. It may block for ever: libiio can hang despite its timeout.
void run_iio_worker(const std::shared_ptr<IioWorker>& line, const IioRequest& request);

}  // namespace proofmass::acquire
