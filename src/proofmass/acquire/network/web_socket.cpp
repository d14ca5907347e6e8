#include "proofmass/acquire/network/web_socket.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/stream/host_text.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::acquire {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

}  // namespace

/// The pending operations. Its context holds the handlers: both are destroyed together, so that no
/// handler is called late.
struct WebSocket::Connection {
  Connection(HostPort to, std::string at, const WebSocketLimits& bounds)
      : server(std::move(to)),
        target(std::move(at)),
        limits(bounds),
        deadline(Clock::now() + bounds.opening) {
    stream.set_option(websocket::stream_base::timeout{limits.opening, limits.silence, true});
    stream.read_message_max(limits.message_bytes);
    resolver.async_resolve(
        server.host, std::to_string(*server.port), [this](error_code failed, const auto& found) {
          if (failed) return fail("finding it", failed);
          asio::async_connect(stream.next_layer(), found, [this](error_code error, const auto&) {
            error ? fail("connecting", error) : shake_hands();
          });
        });
  }
  void shake_hands() {
    stream.async_handshake(text_of(server), target, [this](error_code failed) {
      if (failed) return fail("asking for a WebSocket", failed);
      is_open = true;
      listen();
    });
  }
  void listen() {
    buffer.clear();
    has_message = false;
    stream.async_read(buffer, [this](error_code failed, std::size_t) {
      has_message = !failed;
      if (failed) fail("listening", failed);
    });
  }
  void fail(std::string_view what, error_code failed) {
    std::string why = failed.message();
    if (failed == websocket::error::closed)
      why = fmt::format(
          "the other side closed it ({}{}{})", static_cast<unsigned>(stream.reason().code),
          stream.reason().reason.empty() ? "" : ": ",
          std::string_view(stream.reason().reason.data(), stream.reason().reason.size()));
    // If a peer violates the protocol, Beast closes its own end; if the peer does not answer the
    // close frame, this is all it reports.
    if (failed == asio::error::bad_descriptor)
      why = fmt::format(
          "the connection was closed: it sent what breaks the WebSocket protocol, or a message of "
          "more than {} bytes",
          limits.message_bytes);
    problem = Error{Errc::device, fmt::format("{}: {}", what, why)};
  }

  HostPort server;
  std::string target;
  WebSocketLimits limits;
  Clock::time_point deadline;  ///< for opening
  asio::io_context context{1};
  asio::ip::tcp::resolver resolver{context};
  websocket::stream<asio::ip::tcp::socket, false> stream{context};
  boost::beast::flat_buffer buffer;
  bool is_open = false;
  bool has_message = false;  ///< the buffer holds a complete one
  bool is_returned = false;  ///< it was returned
  std::optional<Error> problem;
};

WebSocket::WebSocket(HostPort server, std::string target, WebSocketLimits limits) {
  PM_EXPECTS(server.port.has_value());
  connection_ = std::make_unique<Connection>(std::move(server), std::move(target), limits);
}

WebSocket::~WebSocket() = default;

bool WebSocket::is_open() const {
  return connection_->is_open;
}

Result<std::optional<std::string_view>> WebSocket::read(std::chrono::milliseconds patience) {
  Connection& now = *connection_;
  if (now.is_returned) {
    now.is_returned = false;
    now.listen();
  }
  const auto until = Clock::now() + patience;
  const auto is_waiting = [&] { return !now.has_message && !now.problem; };
  now.context.restart();
  while (is_waiting() && now.context.poll_one() > 0) {
  }
  while (is_waiting() &&
         now.context.run_one_until(now.is_open ? until : std::min(until, now.deadline)) > 0) {
  }
  if (is_waiting() && !now.is_open && Clock::now() >= now.deadline)
    now.problem = Error{Errc::device, "connecting: no answer"};
  if (now.has_message) {
    now.is_returned = true;
    const auto bytes = now.buffer.cdata();
    return std::optional(std::string_view(static_cast<const char*>(bytes.data()), bytes.size()));
  }
  if (now.problem) return *now.problem;
  return std::optional<std::string_view>();
}

}  // namespace proofmass::acquire
