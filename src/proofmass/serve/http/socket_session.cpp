#include "proofmass/serve/http/socket_session.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/serve/http/token_bucket.hpp"

namespace proofmass::serve {
namespace {

namespace websocket = boost::beast::websocket;

constexpr double messages_per_s = 20.0;
// Few seconds of a picture: what the system takes off our hands is out of date when it arrives.
constexpr int send_buffer_bytes = 256 << 10;

class BrowserSocket final : public SocketSession,
                            public std::enable_shared_from_this<BrowserSocket> {
 public:
  BrowserSocket(boost::beast::tcp_stream stream, SessionsShared& shared);

  void answer(Request request);
  void take(std::uint64_t source, std::shared_ptr<const LiveFrame> frame) override;
  void close() override;

 private:
  struct Queued {
    std::uint64_t source;
    std::shared_ptr<const LiveFrame> frame;
  };
  void read();
  void take_message();
  void push(Queued queued);
  void make_room();
  void write();

  websocket::stream<boost::beast::tcp_stream> stream_;
  SessionsShared& shared_;
  boost::asio::steady_timer stall_;
  Request request_;
  boost::beast::flat_buffer buffer_;
  TokenBucket messages_;
  std::deque<Queued> queue_;
  std::size_t queued_bytes_ = 0, may_be_left_out_ = 0;
  std::uint64_t left_out_ = 0;
  std::string text_;  ///< being written
  bool is_writing_ = false, is_closed_ = false;
};

BrowserSocket::BrowserSocket(boost::beast::tcp_stream stream, SessionsShared& shared)
    : stream_(std::move(stream)),
      shared_(shared),
      stall_(stream_.get_executor()),
      messages_(messages_per_s) {}

void BrowserSocket::answer(Request request) {
  boost::system::error_code ignored;
  auto& tcp = stream_.next_layer();
  tcp.expires_never();
  tcp.socket().set_option(boost::asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
  tcp.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  const ServerLimits& limits = shared_.options.limits;
  stream_.set_option(websocket::stream_base::timeout{limits.head, limits.stall, true});
  stream_.auto_fragment(false);
  stream_.read_message_max(limits.socket_message_bytes);
  request_ = std::move(request);
  stream_.async_accept(request_, [self = shared_from_this()](boost::system::error_code failed) {
    if (failed) return self->close();
    self->stream_.text(true);
    self->read();
  });
}

void BrowserSocket::close() {
  if (std::exchange(is_closed_, true)) return;
  stall_.cancel();
  stream_.next_layer().close();
  queue_.clear();
}

void BrowserSocket::read() {
  buffer_.clear();
  stream_.async_read(buffer_,
                     [self = shared_from_this()](boost::system::error_code failed, std::size_t) {
                       if (failed) return self->close();
                       self->take_message();
                     });
}

void BrowserSocket::take_message() {
  if (!stream_.got_text() || !messages_.take(TokenBucket::Clock::now())) return close();
  const auto bytes = buffer_.cdata();
  const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
  if (const Status taken = shared_.options.live(shared_from_this(), text); !taken) return close();
  read();
}

void BrowserSocket::take(std::uint64_t source, std::shared_ptr<const LiveFrame> frame) {
  boost::asio::post(stream_.get_executor(),
                    [weak = weak_from_this(), source, frame = std::move(frame)] {
                      if (const auto self = weak.lock()) self->push({source, frame});
                    });
}

void BrowserSocket::push(Queued queued) {
  if (is_closed_) return;
  queued_bytes_ += queued.frame->json.size();
  may_be_left_out_ += queued.frame->may_be_left_out ? 1 : 0;
  queue_.push_back(std::move(queued));
  make_room();
  if (!is_writing_ && !is_closed_) write();
}

void BrowserSocket::make_room() {
  const ServerLimits& limits = shared_.options.limits;
  while (queued_bytes_ > limits.socket_queue_bytes ||
         may_be_left_out_ > limits.socket_queue_frames) {
    const auto oldest =
        std::ranges::find_if(queue_, [](const Queued& one) { return one.frame->may_be_left_out; });
    if (oldest == queue_.end()) return close();
    queued_bytes_ -= oldest->frame->json.size();
    --may_be_left_out_;
    ++left_out_;
    queue_.erase(oldest);
  }
}

void BrowserSocket::write() {
  if (queue_.empty()) return;
  const Queued next = std::move(queue_.front());
  queue_.pop_front();
  queued_bytes_ -= next.frame->json.size();
  may_be_left_out_ -= next.frame->may_be_left_out ? 1 : 0;
  text_ = fmt::format("{{\"source\":{},\"left_out\":{},\"frame\":{}}}", next.source, left_out_,
                      next.frame->json);
  is_writing_ = true;
  stall_.expires_after(shared_.options.limits.stall);
  stall_.async_wait([weak = weak_from_this()](boost::system::error_code stopped) {
    if (const auto self = weak.lock(); self && !stopped) self->close();
  });
  stream_.async_write(boost::asio::buffer(text_),
                      [self = shared_from_this()](boost::system::error_code failed, std::size_t) {
                        self->is_writing_ = false;
                        self->stall_.cancel();
                        if (failed) return self->close();
                        self->write();
                      });
}

}  // namespace

std::shared_ptr<SocketSession> SocketSession::begin(boost::beast::tcp_stream stream,
                                                    Request request,
                                                    SessionsShared& shared) {
  auto socket = std::make_shared<BrowserSocket>(std::move(stream), shared);
  socket->answer(std::move(request));
  return socket;
}

}  // namespace proofmass::serve
