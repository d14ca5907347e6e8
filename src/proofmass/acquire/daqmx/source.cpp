#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <future>
#include <thread>
#include <utility>

#include "proofmass/acquire/daqmx/channels.hpp"
#include "proofmass/acquire/daqmx/task.hpp"
#include "proofmass/acquire/recorder/overrun_queue.hpp"
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::size_t most_starts_in_vain = 10;

/// State of the driver's thread; it outlives the source if the driver never returns.
class Listener {
 public:
  Listener(std::unique_ptr<DaqmxTask> task, std::size_t channels)
      : task_(std::move(task)),
        channels_(channels),
        rows_(rows_at_once(task_->rate_hz(), channels)),
        queue_(channels, most_queued_figures / channels) {}

  OverrunQueue& queue() { return queue_; }
  /// The reader has stopped.
  void stop() { is_stopped_ = true; }

  /// Runs until the device is lost or it is stopped.
  void run() {
    while (!is_stopped_) {
      const DaqmxReading reading = task_->read(rows_, figures_);
      if (reading.rows > 0) hand_on(reading.rows);
      if (reading.state == DaqmxReading::State::failed)
        return queue_.end(Error{Errc::device, reading.words});
      if (reading.state == DaqmxReading::State::overrun) {
        if (const Status again = start_anew(reading.words); !again)
          return queue_.end(again.error());
      } else if (!reading.words.empty()) {
        report({Severity::warning, reading.words});
      }
    }
  }

 private:
  static constexpr std::size_t most_figures = std::size_t{1} << 18;  ///< per read
  static constexpr std::size_t most_queued_figures = std::size_t{1} << 22;

  /// Rows in 10 ms.
  static std::size_t rows_at_once(double rate_hz, std::size_t channels) {
    const std::size_t most_rows = most_figures / channels;
    return static_cast<std::size_t>(std::clamp(rate_hz / 100, 1.0, static_cast<double>(most_rows)));
  }

  void hand_on(std::size_t rows) {
    Arrival arrival = queue_.spare();
    for (std::size_t c = 0; c < channels_; ++c)
      for (std::size_t r = 0; r < rows; ++r)
        arrival.channels[c].push_back(figures_[r * channels_ + c]);
    arrival.host_ns = rows_ns_ = host_now_ns();
    arrival.lost_before = std::exchange(lost_, 0);
    starts_in_vain_ = 0;
    queue_.put(std::move(arrival));
  }

  void report(Note note) {
    Arrival arrival = queue_.spare();
    arrival.notes.push_back(std::move(note));
    queue_.put(std::move(arrival));
  }

  /// Restarts the task after rows were lost in the driver or in the card, which ended it.
  Status start_anew(const std::string& words) {
    const auto lost = task_->unread();
    if (++starts_in_vain_ > most_starts_in_vain)
      return Error{Errc::device, fmt::format("{}; the task was restarted {} times without success",
                                             words, most_starts_in_vain)};
    if (const Status again = task_->start_anew(); !again) return again.error();
    // The card acquired nothing from its stop until now; that time is known from the host's clock
    // alone.
    const double silent_s = 1e-9 * static_cast<double>(host_now_ns() - rows_ns_);
    const double missing = std::max(std::round(silent_s * task_->rate_hz()), 1.0);
    lost_ = std::max(static_cast<std::uint64_t>(missing), lost.value_or(0));
    const std::string count = lost ? fmt::format("{} rows that the card took", *lost)
                                   : "rows whose number the driver does not report";
    report({Severity::bad, fmt::format("{}: {} are lost; the task was restarted, and by the "
                                       "host's clock {:.0f} rows are missing",
                                       words, count, missing)});
    return Done{};
  }

  std::unique_ptr<DaqmxTask> task_;
  std::size_t channels_;
  std::size_t rows_;  ///< rows per read
  OverrunQueue queue_;
  std::vector<double> figures_;
  std::int64_t rows_ns_ = host_now_ns();  ///< arrival of the last rows, or start of the task
  std::uint64_t lost_ = 0;                ///< before the next rows
  std::size_t starts_in_vain_ = 0;
  std::atomic<bool> is_stopped_ = false;
};

class DaqmxSource final : public Source {
 public:
  DaqmxSource(std::unique_ptr<DaqmxTask> task, SourceHead head)
      : head_(std::move(head)),
        listener_(std::make_shared<Listener>(std::move(task), head_.recording.channels.size())) {
    std::promise<void> over;
    over_ = over.get_future();
    thread_ = std::thread([listener = listener_, over = std::move(over)]() mutable {
      listener->run();
      over.set_value();
    });
  }

  ~DaqmxSource() override {
    listener_->stop();
    // A read waits a tenth of a second; if the driver never returns, its thread is abandoned.
    if (over_.wait_for(std::chrono::seconds(2)) == std::future_status::ready)
      thread_.join();
    else
      thread_.detach();
  }

  const SourceHead& head() const override { return head_; }

  Result<Arrived> read(Arrival& arrival, std::chrono::milliseconds patience) override {
    return listener_->queue().take(arrival, patience);
  }

 private:
  SourceHead head_;
  std::shared_ptr<Listener> listener_;
  std::future<void> over_;
  std::thread thread_;
};

/// "-5..5"
Status read_range(const std::string& text, DaqmxRequest& request) {
  const std::size_t dots = text.find("..");
  const auto number = [](std::string_view part, double& out) {
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), out);
    return problem == std::errc{} && end == part.data() + part.size() && std::isfinite(out);
  };
  if (dots == std::string::npos ||
      !number(std::string_view(text).substr(0, dots), request.lowest_v) ||
      !number(std::string_view(text).substr(dots + 2), request.highest_v) ||
      request.lowest_v >= request.highest_v)
    return Error{
        Errc::invalid_argument,
        fmt::format("range={}: expected the lowest and highest voltage, as in -5..5", text)};
  return Done{};
}

Result<DaqmxRequest> daqmx_request(SourceUri& uri) {
  DaqmxRequest request;
  auto channels = daqmx_channels(uri.place());
  if (!channels) return channels.error();
  request.channels = std::move(channels).value();
  const auto rate_hz = uri.number("rate", 0.0);
  if (!rate_hz) return rate_hz.error();
  request.rate_hz = rate_hz->value_or(request.rate_hz);
  if (const auto range = uri.value("range"))
    if (const Status read = read_range(*range, request); !read) return read.error();
  const auto terminals = uri.choice("terminal", {"default", "rse", "nrse", "diff", "pseudodiff"});
  if (!terminals) return terminals.error();
  request.terminals = *terminals;
  return request;
}

SourceHead head_of(const SourceUri& uri, const DaqmxRequest& request, const DaqmxTask& task) {
  SourceHead head;
  head.recording.source = uri.text();
  head.recording.format = "NI-DAQmx";
  head.recording.time.source = TimeSource::given_rate;
  head.recording.time.rate_hz = task.rate_hz();
  for (std::string& name : daqmx_names(request.channels))
    head.recording.channels.push_back({std::move(name), *parse_unit("V"), {}});
  head.settings = task.settings(request);
  return head;
}

}  // namespace

Result<std::unique_ptr<Source>> open_daqmx(SourceUri& uri, const OpenOptions& options) {
  const auto request = daqmx_request(uri);
  if (!request) return request.error();
  const std::string library = uri.value("library").value_or(options.nidaqmx_library);
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  auto calls = load_daqmx(library);
  if (!calls) return calls.error();
  auto task = DaqmxTask::start(std::move(calls).value(), *request);
  if (!task) return task.error();
  SourceHead head = head_of(uri, *request, **task);
  return std::unique_ptr<Source>(
      std::make_unique<DaqmxSource>(std::move(task).value(), std::move(head)));
}

Result<std::vector<FoundSource>> find_daqmx(const std::string& library) {
  const auto loaded = load_daqmx(library);
  if (!loaded) return loaded.error();
  const DaqmxCalls& calls = **loaded;
  std::vector<FoundSource> found;
  for (const std::string& device : daqmx_devices(calls)) {
    const auto channels = daqmx_channels_of(calls, device);
    if (channels.empty()) continue;
    found.push_back({"daqmx:" + channels.front(),
                     fmt::format("{}, {} analog inputs up to {}", daqmx_product(calls, device),
                                 channels.size(), channels.back())});
  }
  return found;
}

}  // namespace proofmass::acquire
