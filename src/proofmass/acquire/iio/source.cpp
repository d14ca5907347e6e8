#include <algorithm>
#include <fmt/format.h>
#include <iio.h>
#include <string_view>
#include <utility>

#include "proofmass/acquire/iio/worker.hpp"
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds farewell{1000};  // a thread that has not ended by then hangs

class IioSource : public Source {
 public:
  explicit IioSource(const IioRequest& request)
      : line_(std::make_shared<IioWorker>()),
        thread_([line = line_, request] { run_iio_worker(line, request); }) {}

  // A thread that hangs inside libiio is abandoned on purpose: it cannot be ended, and it uses only
  // the line, which it owns a share of.
  ~IioSource() override {
    std::unique_lock hold(line_->lock);
    line_->is_stopped = true;
    if (line_->buffer != nullptr) iio_buffer_cancel(line_->buffer);
    line_->changed.wait_for(hold, farewell, [&] { return line_->has_ended; });
    const bool has_ended = line_->has_ended;
    hold.unlock();
    if (has_ended)
      thread_.join();
    else
      thread_.detach();
  }

  /// Waits for the first samples. Errors: device, and those of the request.
  Status open(const IioRequest& request, const OpenOptions& options) {
    std::unique_lock hold(line_->lock);
    std::size_t steps = line_->steps;
    auto since = steady_clock::now();
    while (!line_->opened) {
      line_->changed.wait_for(hold, milliseconds(50));
      if (std::exchange(steps, line_->steps) != line_->steps) since = steady_clock::now();
      const auto limit = request.patience + milliseconds(static_cast<long>(1e3 * line_->slack_s));
      if (steady_clock::now() - since > limit + farewell)
        return Error{
            Errc::device,
            fmt::format("{}: waited {:.3g} s for {} and none came; is the "
                        "board up, and does its trigger fire?",
                        request.uri, 1e-3 * static_cast<double>(limit.count()), line_->waits_for)};
      if (options.stopped && options.stopped())
        return Error{Errc::device, request.uri + ": stopped before the first sample"};
    }
    if (!*line_->opened) return line_->opened->error();
    head_ = **line_->opened;
    return Done{};
  }

  [[nodiscard]] const SourceHead& head() const override { return head_; }
  [[nodiscard]] Result<Arrived> read(Arrival& arrival, milliseconds patience) override {
    return line_->queue->take(arrival, patience);
  }

 private:
  std::shared_ptr<IioWorker> line_;
  std::thread thread_;
  SourceHead head_;
};

std::vector<std::string> words_of(std::string_view list) {
  std::vector<std::string> words;
  while (!list.empty()) {
    const std::string_view word = list.substr(0, list.find(','));
    list.remove_prefix(std::min(word.size() + 1, list.size()));
    if (!word.empty()) words.emplace_back(word);
  }
  return words;
}

Result<IioRequest> request_of(SourceUri& uri, const OpenOptions& options) {
  IioRequest request;
  request.uri = uri.place();
  request.device = uri.value("device").value_or("");
  request.trigger = uri.value("trigger").value_or("");
  const auto rate_hz = uri.number("rate", 0.0);
  if (!rate_hz) return rate_hz.error();
  request.rate_hz = *rate_hz;
  request.channels = words_of(uri.value("channels").value_or(""));
  const auto rows = uri.number("buffer", 0.0);
  if (!rows) return rows.error();
  if (*rows) request.buffer_rows = static_cast<std::size_t>(std::clamp(**rows, 1.0, 1e6));
  const Status known = uri.nothing_unknown();
  if (!known) return known.error();
  if (request.uri.find(':') == std::string::npos)
    return Error{Errc::invalid_argument,
                 fmt::format("\"{}\": expected libiio's address of a board: local:, ip:HOST, "
                             "usb:BUS.DEVICE.INTERFACE",
                             request.uri)};
  request.patience = std::max(options.patience, milliseconds(100));
  return request;
}

}  // namespace

Result<std::unique_ptr<Source>> open_iio(SourceUri& uri, const OpenOptions& options) {
  const auto request = request_of(uri, options);
  if (!request) return request.error();
  auto source = std::make_unique<IioSource>(*request);
  const Status opened = source->open(*request, options);
  if (!opened) return opened.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace proofmass::acquire
