#include "proofmass/acquire/iio/worker.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fmt/format.h>
#include <iio.h>
#include <utility>

#include "proofmass/acquire/clock/stamp_watch.hpp"
#include "proofmass/acquire/iio/columns.hpp"
#include "proofmass/acquire/iio/handle.hpp"
#include "proofmass/acquire/iio/timing.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::size_t kernel_rows = 65536;                   // at most, in 32 buffers: 2.5 s
constexpr double buffer_s = 0.08;                            // per buffer
constexpr std::size_t queued_bytes = std::size_t{32} << 20;  // for a late reader

struct Board {
  IioContext context;
  iio_device* device = nullptr;
  IioColumns columns;
  IioTiming timing;
};

void step(IioWorker& line, std::string waits_for, double slack_s = 0.0) {
  const std::scoped_lock hold(line.lock);
  line.waits_for = std::move(waits_for);
  line.slack_s = slack_s;
  ++line.steps;
  line.changed.notify_all();
}

Result<Board> find_board(IioWorker& line, const IioRequest& request) {
  step(line, "an answer");
  Board board;
  board.context = open_iio_context(request.uri);
  if (!board.context)
    return Error{Errc::device,
                 fmt::format("{}: no board there ({}); is iiod running, and the address right?",
                             request.uri, iio_reason(errno))};
  // libiio gives a board half of its own timeout, so that a board waiting in vain for its trigger
  // reports it before the connection counts as dead.
  const auto timeout_ms = request.patience.count() * (request.uri.starts_with("local:") ? 1 : 2);
  (void)iio_context_set_timeout(board.context.get(), static_cast<unsigned>(timeout_ms));
  step(line, "its settings");
  const auto device = choose_device(board.context.get(), request.device);
  if (!device) return device.error();
  board.device = *device;
  auto columns = choose_columns(board.device, request.channels);
  if (!columns) return columns.error();
  board.columns = std::move(columns).value();
  auto timing = set_timing(board.context.get(), board.device, request.trigger, request.rate_hz);
  if (!timing) return timing.error();
  board.timing = std::move(timing).value();
  return board;
}

Error refill_failed(const Board& board, long code) {
  const std::string name = iio_name(board.device);
  if (code == -ETIMEDOUT)
    return {Errc::device, fmt::format("{}: no sample comes: {}", name, board.timing.why_silent)};
  if (code == -EBUSY)
    return {
        Errc::device,
        fmt::format("{}: its buffer cannot be enabled: another program reads it; stop it", name)};
  if (code == -EPIPE || code == -ECONNRESET || code == -ENODEV)
    return {Errc::device, fmt::format("{}: the board is gone: the connection broke, or it does not "
                                      "answer ({})",
                                      name, iio_reason(code))};
  return {Errc::device, fmt::format("{}: reading its buffer failed ({}); {}", name,
                                    iio_reason(code), board.timing.why_silent)};
}

SourceHead head_of(const Board& board, const IioRequest& request, const Arrival& first) {
  SourceHead head;
  head.recording.source = "iio:" + request.uri;
  head.recording.format = "IIO";
  head.recording.channels = board.columns.heads;
  head.recording.time.source = TimeSource::given_rate;
  head.recording.time.rate_hz = board.timing.rate_hz;
  head.recording.notes = board.columns.notes;
  std::ranges::copy(board.timing.notes, std::back_inserter(head.recording.notes));
  head.settings.emplace_back("device", iio_name(board.device));
  for (const auto* settings : {&board.timing.settings, &board.columns.settings})
    std::ranges::copy(*settings, std::back_inserter(head.settings));
  head.has_device_clock = board.columns.stamp != nullptr && !is_dead(first.device_ns);
  const bool is_dead_clock = board.columns.stamp != nullptr && !head.has_device_clock;
  head.settings.emplace_back("timestamps", head.has_device_clock ? "the device's"
                                           : is_dead_clock       ? "dead"
                                                                 : "none");
  if (is_dead_clock)
    head.recording.notes.push_back(
        {Severity::warning, fmt::format("{}: its timestamps are dead (all are {}): time is counted "
                                        "by the rate; a trigger of the device's own may mend it",
                                        iio_name(board.device), first.device_ns.front())});
  return head;
}

/// A buffer that other threads may cancel during its lifetime.
class OpenBuffer {
 public:
  OpenBuffer(IioWorker& line, iio_device* device, std::size_t rows) : line_(line) {
    errno = 0;
    buffer_ = iio_device_create_buffer(device, rows, false);
    code_ = buffer_ == nullptr ? -errno : 0;
    publish(buffer_);
  }
  OpenBuffer(const OpenBuffer&) = delete;
  OpenBuffer& operator=(const OpenBuffer&) = delete;
  ~OpenBuffer() {
    publish(nullptr);
    if (buffer_ != nullptr) iio_buffer_destroy(buffer_);
  }

  /// Waits for the next rows: 0 or an error number.
  long refill() {
    return buffer_ == nullptr ? code_ : std::min<long>(iio_buffer_refill(buffer_), 0);
  }
  [[nodiscard]] iio_buffer* get() const { return buffer_; }
  [[nodiscard]] bool is_stopped() const {
    const std::scoped_lock hold(line_.lock);
    return line_.is_stopped;
  }

 private:
  void publish(iio_buffer* buffer) {
    const std::scoped_lock hold(line_.lock);
    line_.buffer = buffer;
    if (buffer != nullptr && line_.is_stopped) iio_buffer_cancel(buffer);
  }
  IioWorker& line_;
  iio_buffer* buffer_;
  long code_;
};

// Passes on rows, starting with those in the buffer. Returns the reason for the end.
std::optional<Error> hand_over(const Board& board, IioWorker& line, OpenBuffer& buffer) {
  StampWatch watch;
  bool has_clock = false;
  {
    const std::scoped_lock hold(line.lock);
    has_clock = (*line.opened)->has_device_clock;
  }
  while (true) {
    Arrival arrival = line.queue->spare();
    const Status decoded = decode(buffer.get(), board.columns, arrival);
    if (!decoded) return decoded.error();
    arrival.host_ns = host_now_ns();
    if (!has_clock) arrival.device_ns.clear();
    watch.look(arrival.device_ns, arrival.notes);
    line.queue->put(std::move(arrival));
    long code = -ETIMEDOUT;
    // A board that reports a timeout of its trigger is still connected.
    while (code == -ETIMEDOUT && !buffer.is_stopped()) code = buffer.refill();
    if (buffer.is_stopped()) return std::nullopt;
    if (code < 0) return refill_failed(board, code);
  }
}

// Errors: of opening only.
Status serve(IioWorker& line, const IioRequest& request) {
  const auto board = find_board(line, request);
  if (!board) return board.error();
  const double rate_hz = board->timing.rate_hz;
  const std::size_t rows = request.buffer_rows.value_or(
      rate_hz > 0.0 ? static_cast<std::size_t>(std::clamp(rate_hz * buffer_s, 1.0, 1e5)) : 8);
  enable(board->device, board->columns);
  // Kernel buffers for an unsteady connection.
  (void)iio_device_set_kernel_buffers_count(
      board->device, static_cast<unsigned>(std::clamp<std::size_t>(kernel_rows / rows, 4, 32)));
  // libiio itself replies within twice the patience, and the board's message is more informative
  // than ours.
  const double period_s = rate_hz > 0.0 ? static_cast<double>(rows) / rate_hz : 0.0;
  step(line, "samples", 1e-3 * static_cast<double>(request.patience.count()) + 3.0 * period_s);
  OpenBuffer buffer(line, board->device, rows);
  const long code = buffer.refill();
  if (code < 0) return refill_failed(*board, code);
  Arrival first;
  first.clear(board->columns.heads.size());
  const Status decoded = decode(buffer.get(), board->columns, first);
  if (!decoded) return decoded.error();
  {
    const std::scoped_lock hold(line.lock);
    line.queue = std::make_unique<OverrunQueue>(
        first.channels.size(), queued_bytes / (sizeof(double) * (first.channels.size() + 1)));
    line.opened = head_of(*board, request, first);
    line.changed.notify_all();
  }
  line.queue->end(hand_over(*board, line, buffer));
  return Done{};
}

}  // namespace

void run_iio_worker(const std::shared_ptr<IioWorker>& line, const IioRequest& request) {
  block_broken_pipes();
  const Status served = serve(*line, request);
  const std::scoped_lock hold(line->lock);
  if (!served) line->opened = served.error();
  line->has_ended = true;
  line->changed.notify_all();
}

}  // namespace proofmass::acquire
