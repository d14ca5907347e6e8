#include "proofmass/serve/http/session.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cctype>
#include <exception>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <unistd.h>

#include "proofmass/core/version.hpp"
#include "proofmass/serve/http/request_head.hpp"
#include "proofmass/serve/http/socket_session.hpp"
#include "proofmass/serve/temporary.hpp"

namespace proofmass::serve {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using Message = http::response<http::string_body>;

// A file's name in a header: letters, digits and what is harmless among them.
std::string plain_name(std::string name) {
  std::ranges::replace_if(
      name,
      [](char c) { return !std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-'; },
      '_');
  return name;
}

Message message_of(Response response, const ServerOptions& options) {
  Message message;
  message.result(response.status);
  message.set(http::field::server, fmt::format("proofmass/{}", version()));
  message.set(http::field::content_type, response.content_type);
  message.set(http::field::cache_control, "no-store");
  message.set("Content-Security-Policy", options.content_security_policy);
  message.set("X-Content-Type-Options", "nosniff");
  message.set("X-Frame-Options", "DENY");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set("Cross-Origin-Opener-Policy", "same-origin");
  if (!response.file_name.empty())
    message.set(http::field::content_disposition,
                fmt::format("attachment; filename=\"{}\"", plain_name(response.file_name)));
  message.body() = std::move(response.body);
  return message;
}

}  // namespace

/// One connection: reads a request, has it answered, and waits for the next. It lives as long as a
/// handler holds it.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(asio::ip::tcp::socket socket, SessionsShared& shared)
      : stream_(std::move(socket)), shared_(shared) {}
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void begin() { read_head(); }
  void close() {
    error_code ignored;
    stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
    stream_.close();
  }
  [[nodiscard]] bool is_waiting() const { return waits_; }

 private:
  void read_head() {
    parser_.emplace();
    parser_->header_limit(shared_.options.limits.head_bytes);
    parser_->body_limit(shared_.options.limits.upload_bytes);
    waits_ = true;
    stream_.expires_after(shared_.options.limits.head);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code failed, std::size_t) {
                              self->waits_ = false;
                              self->take_head(failed);
                            });
  }

  void take_head(error_code failed) {
    if (failed == http::error::header_limit)
      return refuse(error_response(431, "the head of the request is too long"));
    if (failed == http::error::body_limit)
      return refuse(error_response(413, "the body of the request is too long"));
    if (failed &&
        failed.category() == http::make_error_code(http::error::end_of_stream).category() &&
        failed != http::error::end_of_stream && failed != http::error::partial_message)
      return refuse(error_response(400, "this is not an HTTP request"));
    if (failed) return close();
    const RequestHead head = head_of(parser_->get());
    const auto now = TokenBucket::Clock::now();
    // Whoever has no token cannot use up what those with one may ask.
    if (auto response = refusal(shared_.gate, head))
      return shared_.refusals.take(now) ? refuse(shell_or(*response, head)) : close();
    if (!shared_.requests.take(now))
      return refuse(error_response(429, "too many requests: wait a second"));
    auto target = parse_target(head.target).value();
    if (beast::websocket::is_upgrade(parser_->get())) return upgrade(target);
    request_ = {.method = head.method, .target = std::move(target), .body = {}};
    if (request_.method == "PUT") return read_upload();
    // The parser has checked the length that the head names against the limit of uploads.
    if (parser_->content_length().value_or(0) > shared_.options.limits.body_bytes)
      return refuse(error_response(413, "the body of the request is too long"));
    read_body();
  }

  void upgrade(const Target& target) {
    if (!shared_.options.live || target.path != live_path)
      return refuse(error_response(404, "there is no WebSocket here"));
    std::erase_if(shared_.sockets, [](const auto& one) { return one.expired(); });
    if (shared_.sockets.size() >= shared_.options.limits.sockets)
      return refuse(error_response(503, "too many browsers: close one"));
    shared_.sockets.push_back(
        SocketSession::begin(std::move(stream_), parser_->release(), shared_));
  }

  /// Who comes to the page without a token sees it all the same, without anything of the folder: a
  /// tab that is loaded anew has its token in its own storage.
  [[nodiscard]] Response shell_or(Response response, const RequestHead& head) const {
    if (response.status != 403 || head.method != "GET") return response;
    const auto target = parse_target(head.target);
    if (!target || target->path != "/" || head.origin) return response;
    return {403, shared_.options.page, "text/html; charset=utf-8"};
  }

  void read_body() {
    body_.emplace(std::move(*parser_));
    body_->body_limit(shared_.options.limits.body_bytes);
    stream_.expires_after(shared_.options.limits.stall);
    http::async_read(stream_, buffer_, *body_,
                     [self = shared_from_this()](error_code failed, std::size_t) {
                       if (failed == http::error::body_limit)
                         return self->refuse(error_response(413, "the body is too long"));
                       if (failed) return self->close();
                       self->request_.body = std::move(self->body_->get().body());
                       self->keep_alive_ = self->body_->keep_alive();
                       self->answer();
                     });
  }

  void read_upload() {
    auto made = temporary_file(shared_.options.upload_folder, ".proofmass-upload-");
    if (!made) return refuse(error_response(507, made.error().message));
    request_.body_path = std::move(made).value();
    upload_.emplace(std::move(*parser_));
    error_code failed;
    upload_->get().body().open(request_.body_path.c_str(), beast::file_mode::write, failed);
    if (failed) return refuse(error_response(507, failed.message()));
    read_more();
  }

  // In pieces, so that the time limit is one between them.
  void read_more() {
    stream_.expires_after(shared_.options.limits.stall);
    http::async_read_some(stream_, buffer_, *upload_,
                          [self = shared_from_this()](error_code failed, std::size_t) {
                            if (failed) {
                              self->remove_upload();
                              return self->close();
                            }
                            if (!self->upload_->is_done()) return self->read_more();
                            self->keep_alive_ = self->upload_->keep_alive();
                            self->upload_->get().body().close();
                            self->answer();
                          });
  }

  void answer() {
    stream_.expires_never();
    if (request_.method == "GET" && request_.target.path == "/")
      return write({200, shared_.options.page, "text/html; charset=utf-8"});
    asio::post(shared_.workers, [self = shared_from_this()] {
      Response response = self->handled();
      self->remove_upload();
      asio::post(self->stream_.get_executor(), [self, response = std::move(response)]() mutable {
        self->write(std::move(response));
      });
    });
  }

  // Whatever goes wrong with one request, the others are answered.
  [[nodiscard]] Response handled() const {
    try {
      return shared_.handler(request_);
    } catch (const std::exception& problem) {
      return error_response(500, problem.what());
    }
  }

  void remove_upload() {
    if (!request_.body_path.empty()) ::unlink(request_.body_path.c_str());
    request_.body_path.clear();
  }

  void refuse(Response response) {
    keep_alive_ = false;
    remove_upload();
    write(std::move(response));
  }

  void write(Response response) {
    if (!stream_.socket().is_open()) return;
    message_ = message_of(std::move(response), shared_.options);
    message_.version(11);
    message_.keep_alive(keep_alive_);
    message_.prepare_payload();
    stream_.expires_after(shared_.options.limits.stall);
    http::async_write(stream_, message_,
                      [self = shared_from_this()](error_code failed, std::size_t) {
                        if (failed || !self->keep_alive_) return self->close();
                        self->read_head();
                      });
  }

  beast::tcp_stream stream_;
  SessionsShared& shared_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<http::request_parser<http::string_body>> body_;
  std::optional<http::request_parser<http::file_body>> upload_;
  Request request_;
  Message message_;
  bool keep_alive_ = false;
  bool waits_ = false;
};

void SessionsShared::admit(asio::ip::tcp::socket socket) {
  std::erase_if(sessions, [](const auto& one) { return one.expired(); });
  if (sessions.size() >= options.limits.connections) {
    const auto waiting = std::ranges::find_if(sessions, [](const auto& one) {
      const auto session = one.lock();
      return session && session->is_waiting();
    });
    if (waiting == sessions.end()) return;  // all are at work: the new one is closed
    if (const auto session = waiting->lock()) session->close();
    sessions.erase(waiting);
  }
  const auto session = std::make_shared<Session>(std::move(socket), *this);
  sessions.push_back(session);
  session->begin();
}

void SessionsShared::close_all() {
  for (const auto& one : sessions)
    if (const auto session = one.lock()) session->close();
  sessions.clear();
  for (const auto& one : sockets)
    if (const auto socket = one.lock()) socket->close();
  sockets.clear();
}

}  // namespace proofmass::serve
