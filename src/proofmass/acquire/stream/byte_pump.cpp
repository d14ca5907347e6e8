#include "proofmass/acquire/stream/byte_pump.hpp"

#include <poll.h>
#include <string_view>
#include <utility>

namespace proofmass::acquire {
namespace {

class StreamSource final : public Source {
 public:
  StreamSource(std::unique_ptr<BytePump> feed,
               std::unique_ptr<Decoder> decoder,
               Carrier carrier,
               SourceHead head)
      : feed_(std::move(feed)),
        decoder_(std::move(decoder)),
        carrier_(carrier),
        head_(std::move(head)),
        buffer_(feed_bytes) {}

  Status begin(const OpenOptions& options) {
    const Status there = await_rows(*decoder_, options, [&](auto wait) { return pump(wait); });
    if (there) decoder_->describe(head_);
    return there;
  }
  const SourceHead& head() const override { return head_; }
  Result<Arrived> read(Arrival& arrival, std::chrono::milliseconds patience) override {
    bool has_more = !ended_;
    if (has_more && !decoder_->has_rows()) {
      const auto pumped = pump(patience);
      if (!pumped) return pumped.error();
      has_more = *pumped;
    }
    if (has_more && carrier_ == Carrier::datagrams) {
      const Status taken = take_what_waits();
      if (!taken) return taken.error();
    }
    const bool has_rows = decoder_->hand_out(arrival);
    std::vector<Note> notes = feed_->take_notes();
    arrival.notes.insert(arrival.notes.end(), notes.begin(), notes.end());
    if (has_rows) return Arrived::rows;
    return has_more ? Arrived::nothing : Arrived::ended;
  }

 private:
  Result<bool> pump(std::chrono::milliseconds patience) {
    const auto fed = feed_->read(buffer_, patience);
    if (!fed) return fed.error();
    const std::int64_t host_ns = host_now_ns();
    const std::string_view bytes(buffer_.data(), fed->bytes);
    if (fed->lost > 0) decoder_->lose(fed->lost);
    if (carrier_ == Carrier::datagrams && fed->bytes > 0) decoder_->take_packet(bytes, host_ns);
    if (carrier_ != Carrier::datagrams && fed->bytes > 0) decoder_->take(bytes, host_ns);
    if (fed->ended && !std::exchange(ended_, true)) decoder_->finish(host_ns);
    is_dry_ = fed->bytes == 0;
    return !ended_;
  }
  /// Packets are small and many may be waiting: takes all of them into one arrival.
  Status take_what_waits() {
    constexpr int most_packets = 64;
    for (int i = 0; i < most_packets && !is_dry_ && !ended_; ++i) {
      const auto pumped = pump(std::chrono::milliseconds(0));
      if (!pumped) return pumped.error();
    }
    return Done{};
  }

  std::unique_ptr<BytePump> feed_;
  std::unique_ptr<Decoder> decoder_;
  Carrier carrier_;
  SourceHead head_;
  bool ended_ = false;
  bool is_dry_ = false;  ///< no data were available
  std::vector<char> buffer_;
};

}  // namespace

bool wait_readable(int descriptor, std::chrono::milliseconds patience) {
  pollfd watched{descriptor, POLLIN, 0};
  // A signal may end the wait early, as if no data had arrived.
  return ::poll(&watched, 1, static_cast<int>(patience.count())) > 0;
}

Result<std::unique_ptr<Source>> open_stream(std::unique_ptr<BytePump> feed,
                                            const FramingOptions& framing,
                                            SourceHead head,
                                            const OpenOptions& options) {
  auto decoder = Decoder::make(framing);
  if (!decoder) return decoder.error();
  auto source = std::make_unique<StreamSource>(std::move(feed), std::move(decoder).value(),
                                               framing.carrier, std::move(head));
  if (const Status begun = source->begin(options); !begun) return begun.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace proofmass::acquire
