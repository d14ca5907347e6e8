#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <string_view>
#include <unistd.h>
#include <utility>

#include "proofmass/acquire/comedi/command.hpp"
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {
namespace {

using std::chrono::milliseconds;

class ComediSource : public Source {
 public:
  ComediSource(ComediCommand command, const std::string& uri)
      : card_(std::move(command)), file_(comedi_fileno(card_.device.get())) {
    head_.recording.source = uri;
    head_.recording.format = "comedi";
    head_.recording.channels = card_.heads;
    head_.recording.notes = card_.notes;
    head_.recording.time.source = TimeSource::given_rate;
    head_.recording.time.rate_hz = card_.rate_hz;
    head_.settings = card_.settings;
    const std::size_t row_bytes = card_.sample_bytes * card_.heads.size();
    const auto rows = static_cast<std::size_t>(std::clamp(0.1 * card_.rate_hz, 1.0, 1e5));
    bytes_.resize(rows * row_bytes);
  }
  ~ComediSource() override { comedi_cancel(card_.device.get(), card_.subdevice); }

  Status begin() {
    const int flags = fcntl(file_, F_GETFL);
    if (flags < 0 || fcntl(file_, F_SETFL, flags | O_NONBLOCK) < 0)
      return Error{Errc::device, std::string("the card's file: ") + std::strerror(errno)};
    last_ns_ = host_now_ns();
    return start(card_);
  }

  [[nodiscard]] const SourceHead& head() const override { return head_; }

  [[nodiscard]] Result<Arrived> read(Arrival& arrival, milliseconds patience) override {
    arrival.clear(card_.heads.size());
    pollfd waiting{file_, POLLIN, 0};
    const int ready =
        poll(&waiting, 1, static_cast<int>(std::clamp<long>(patience.count(), 0, 1000000)));
    if (ready == 0 || (ready < 0 && errno == EINTR)) return Arrived::nothing;
    if (ready < 0) return gone();
    const ssize_t count = ::read(file_, bytes_.data() + filled_, bytes_.size() - filled_);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return Arrived::nothing;
    if (count < 0 && errno == EPIPE) return restart(arrival);
    if (count < 0) return gone();
    if (count == 0) return Error{Errc::device, "the card has stopped sampling"};
    filled_ += static_cast<std::size_t>(count);
    take_rows(arrival);
    return arrival.rows() > 0 ? Arrived::rows : Arrived::nothing;
  }

 private:
  [[nodiscard]] Error gone() const {
    return {Errc::device, fmt::format("the card is gone ({})", std::strerror(errno))};
  }

  [[nodiscard]] double volts(std::size_t channel, const std::byte* at) const {
    lsampl_t figure = 0;
    if (card_.sample_bytes == sizeof(sampl_t)) {
      sampl_t half = 0;
      std::memcpy(&half, at, sizeof half);
      figure = half;
    } else {
      std::memcpy(&figure, at, sizeof figure);
    }
    return comedi_to_physical(figure, &card_.to_physical[channel]);
  }

  // A read may end within a row: the remainder waits for the next one.
  void take_rows(Arrival& arrival) {
    const std::size_t row_bytes = card_.sample_bytes * card_.heads.size();
    const std::size_t rows = filled_ / row_bytes;
    const std::byte* at = bytes_.data();
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t channel = 0; channel < arrival.channels.size(); ++channel) {
        arrival.channels[channel].push_back(volts(channel, at));
        at += card_.sample_bytes;
      }
    filled_ -= rows * row_bytes;
    std::memmove(bytes_.data(), at, filled_);
    if (rows == 0) return;
    arrival.host_ns = last_ns_ = host_now_ns();
    arrival.lost_before = std::exchange(lost_, 0);
    has_restarted_ = false;
  }

  // The driver's buffer overflowed and the acquisition stopped. The number of missing rows follows
  // from the clock alone.
  Result<Arrived> restart(Arrival& arrival) {
    if (std::exchange(has_restarted_, true))
      return Error{Errc::device,
                   "the card's buffer overflows before it is read: request a lower "
                   "rate or fewer channels"};
    comedi_cancel(card_.device.get(), card_.subdevice);
    filled_ = 0;
    const Status started = start(card_);
    if (!started) return started.error();
    const double silent_s = 1e-9 * static_cast<double>(host_now_ns() - last_ns_);
    lost_ += static_cast<std::uint64_t>(std::max(1.0, std::round(silent_s * card_.rate_hz)));
    arrival.notes.push_back(
        {Severity::warning, fmt::format("the card's buffer overflowed and it was restarted: about "
                                        "{} rows are missing",
                                        lost_)});
    return Arrived::nothing;
  }

  ComediCommand card_;
  int file_;
  SourceHead head_;
  std::vector<std::byte> bytes_;
  std::size_t filled_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint64_t lost_ = 0;
  bool has_restarted_ = false;  // and has returned no row since
};

Result<std::vector<unsigned>> channels_in(std::string_view list) {
  std::vector<unsigned> channels;
  while (!list.empty()) {
    const std::string_view word = list.substr(0, list.find(','));
    unsigned channel = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, problem] = std::from_chars(word.data(), end, channel);
    if (problem != std::errc{} || stop != end ||
        std::ranges::find(channels, channel) != channels.end())
      return Error{Errc::invalid_argument,
                   fmt::format("channels={}: expected different numbers such as 0,1,2", word)};
    channels.push_back(channel);
    list.remove_prefix(std::min(word.size() + 1, list.size()));
  }
  return channels;
}

Result<ComediRequest> comedi_request(SourceUri& uri) {
  ComediRequest request{uri.place()};
  const auto channels = channels_in(uri.value("channels").value_or(""));
  if (!channels) return channels.error();
  request.channels = *channels;
  const auto rate_hz = uri.number("rate", 0.0);
  if (!rate_hz) return rate_hz.error();
  request.rate_hz = rate_hz->value_or(request.rate_hz);
  const auto range = uri.number("range", -1.0);
  if (!range) return range.error();
  request.range = static_cast<unsigned>(std::clamp(range->value_or(0.0), 0.0, 255.0));
  constexpr std::array words{std::string_view("ground"), std::string_view("common"),
                             std::string_view("diff"), std::string_view("other")};
  const auto reference = uri.choice("aref", {words.begin(), words.end()});
  if (!reference) return reference.error();
  // Numbered in this order: AREF_GROUND is 0.
  request.reference =
      static_cast<unsigned>(std::ranges::find(words, std::string_view(*reference)) - words.begin());
  const Status known = uri.nothing_unknown();
  if (!known) return known.error();
  return request;
}

}  // namespace

Result<std::unique_ptr<Source>> open_comedi(SourceUri& uri, const OpenOptions&) {
  const auto request = comedi_request(uri);
  if (!request) return request.error();
  auto command = prepare_command(*request);
  if (!command) return command.error();
  auto source = std::make_unique<ComediSource>(std::move(command).value(), uri.text());
  const Status begun = source->begin();
  if (!begun) return begun.error();
  return std::unique_ptr<Source>(std::move(source));
}

Result<std::vector<FoundSource>> find_comedi() {
  std::vector<FoundSource> found;
  for (int card = 0; card < 16; ++card) {
    ComediRequest request;
    request.path = fmt::format("/dev/comedi{}", card);
    if (access(request.path.c_str(), R_OK) != 0) continue;
    const auto command = prepare_command(request);
    found.push_back({"comedi:" + request.path,
                     command ? fmt::format("{}: {} channels", command->settings.front().second,
                                           command->heads.size())
                             : command.error().message});
  }
  return found;
}

}  // namespace proofmass::acquire
