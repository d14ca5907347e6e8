#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "proofmass/acquire/overrun_queue.hpp"
#include "proofmass/acquire/source.hpp"

struct iio_buffer;

namespace proofmass::acquire {

struct IioRequest {
  std::string uri{}, device{}, trigger{};  // libiio's own URI; names are empty where none is said
  std::optional<double> rate_hz{};
  std::vector<std::string> channels{};
  std::optional<std::size_t> buffer_rows{};
  std::chrono::milliseconds patience{};
};

/// What the thread that speaks with libiio shares with the one that reads the source. All but the
/// queue is under the lock.
struct IioLine {
  std::mutex lock{};
  std::condition_variable changed{};
  std::string waits_for{};  ///< what the board owes: "an answer"; it begins anew with each
  std::size_t steps = 0;    ///< taken so far
  double slack_s = 0.0;     ///< longer than its patience, where the rate is low
  std::optional<Result<SourceHead>> opened{};
  std::unique_ptr<OverrunQueue> queue{};  ///< set with `opened`, and not changed from then on
  iio_buffer* buffer = nullptr;           ///< while it may be cancelled
  bool is_stopped = false;                ///< nobody reads any more
  bool has_ended = false;                 ///< the thread has let go of libiio
};

/// Opens the board, tells the line, and hands over what comes until it is stopped or the board
/// fails. It may block for ever: libiio can hang in spite of its timeout.
void run_iio_line(const std::shared_ptr<IioLine>& line, const IioRequest& request);

}  // namespace proofmass::acquire
