#include "proofmass/acquire/network/http_client.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/stream/host_text.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::acquire {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

}  // namespace

/// The pending request. Its context holds the handlers: both are destroyed together, so that no
/// handler is called late.
struct HttpClient::Connection {
  Connection(const HostPort& to, const HttpLimits& bounds) : server(to), limits(bounds) {}

  void begin() {
    deadline = Clock::now() + limits.answer;
    was_open = socket.is_open();
    was_open ? send() : connect();
  }
  void connect() {
    resolver.async_resolve(
        server.host, std::to_string(*server.port), [this](error_code failed, const auto& found) {
          if (failed) return fail("finding it", failed);
          asio::async_connect(socket, found, [this](error_code error, const auto&) {
            error ? fail("connecting", error) : send();
          });
        });
  }
  void send() {
    parser.emplace();
    parser->body_limit(limits.body_bytes);
    http::async_write(socket, request, [this](error_code failed, std::size_t) {
      failed ? retry("asking", failed) : receive();
    });
  }
  void receive() {
    http::async_read(socket, buffer, *parser, [this](error_code failed, std::size_t bytes) {
      if (failed)
        return bytes == 0 ? retry("waiting for its answer", failed)
                          : fail("reading its answer", failed);
      const bool stays = parser->keep_alive();
      outcome = HttpAnswer{parser->get().result_int(), std::move(parser->get().body())};
      if (!stays) close();
    });
  }
  /// A server may close a persistent connection just as the next request is sent.
  void retry(std::string_view what, error_code failed) {
    if (!was_open) return fail(what, failed);
    was_open = false;
    close();
    connect();
  }
  void close() {
    error_code ignored;
    socket.close(ignored);
    buffer.clear();
  }
  void fail(std::string_view what, error_code failed) {
    outcome = Error{Errc::device, fmt::format("{}: {}", what, failed.message())};
  }

  const HostPort& server;
  const HttpLimits& limits;
  asio::io_context context{1};
  asio::ip::tcp::resolver resolver{context};
  asio::ip::tcp::socket socket{context};
  boost::beast::flat_buffer buffer;
  http::request<http::empty_body> request;
  std::optional<http::response_parser<http::string_body>> parser;
  bool was_open = false;  ///< an earlier response came over this connection
  bool is_waiting = false;
  Clock::time_point deadline{};
  std::optional<Result<HttpAnswer>> outcome;
};

HttpClient::HttpClient(HostPort server, HttpLimits limits)
    : server_(std::move(server)),
      limits_(limits),
      connection_(std::make_unique<Connection>(server_, limits_)) {
  PM_EXPECTS(server_.port.has_value());
}

HttpClient::~HttpClient() = default;

bool HttpClient::is_waiting() const {
  return connection_->is_waiting;
}

void HttpClient::ask(const std::string& target) {
  PM_EXPECTS(!is_waiting());
  auto& request = connection_->request;
  request = {http::verb::get, target, 11};
  request.set(http::field::host, text_of(server_));
  request.keep_alive(true);
  connection_->is_waiting = true;
  connection_->outcome.reset();
  connection_->begin();
}

Result<std::optional<HttpAnswer>> HttpClient::answer(std::chrono::milliseconds patience) {
  PM_EXPECTS(is_waiting());
  Connection& now = *connection_;
  now.context.restart();
  now.context.poll();
  const auto until = std::min(Clock::now() + patience, now.deadline);
  if (!now.outcome) now.context.run_until(until);
  if (!now.outcome && Clock::now() >= now.deadline)
    now.outcome =
        Error{Errc::device, fmt::format("no answer within {} s",
                                        std::chrono::duration<double>(limits_.answer).count())};
  if (!now.outcome) return std::optional<HttpAnswer>();
  now.is_waiting = false;
  Result<HttpAnswer> outcome = *std::move(now.outcome);
  if (outcome) return std::optional(std::move(outcome).value());
  connection_ = std::make_unique<Connection>(server_, limits_);
  return outcome.error();
}

}  // namespace proofmass::acquire
