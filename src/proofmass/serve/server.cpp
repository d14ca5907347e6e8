#include "proofmass/serve/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <fmt/format.h>
#include <memory>
#include <utility>

#include "proofmass/serve/http/session.hpp"

namespace proofmass::serve {

namespace asio = boost::asio;
using boost::system::error_code;

struct Server::State {
  State(ServerOptions given, Handler answers)
      : shared{std::move(given), std::move(answers)}, acceptor(context) {}

  void accept() {
    acceptor.async_accept([this](error_code failed, asio::ip::tcp::socket socket) {
      if (failed == asio::error::operation_aborted) return;
      if (failed) return accept_later();
      shared.admit(std::move(socket));
      accept();
    });
  }
  /// No descriptor is left, or the like: trying again at once would burn a processor.
  void accept_later() {
    constexpr std::chrono::milliseconds pause{100};
    retry.expires_after(pause);
    retry.async_wait([this](error_code stopped) {
      if (!stopped) accept();
    });
  }
  void watch(const std::function<bool()>& ended) {
    constexpr std::chrono::milliseconds period{100};
    watcher.expires_after(period);
    watcher.async_wait([this, &ended](error_code stopped) {
      if (stopped) return;
      if (ended())
        end();
      else
        watch(ended);
    });
  }
  void end() {
    error_code ignored;
    acceptor.close(ignored);
    retry.cancel();
    shared.close_all();
  }

  asio::io_context context{1};
  SessionsShared shared;
  asio::ip::tcp::acceptor acceptor;
  asio::steady_timer watcher{context}, retry{context};
};

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::listen(ServerOptions options, Handler handler) {
  const std::string where = fmt::format("{}:{}", in_link(options.address), options.port);
  auto state = std::make_unique<State>(std::move(options), std::move(handler));
  ServerOptions& own = state->shared.options;
  error_code failed;
  const auto address = asio::ip::make_address(own.address, failed);
  if (failed)
    return Error{Errc::invalid_argument,
                 fmt::format("{}: expected an address such as 127.0.0.1 or ::1", own.address)};
  const asio::ip::tcp::endpoint endpoint(address, own.port);
  auto& acceptor = state->acceptor;
  acceptor.open(endpoint.protocol(), failed);
  if (!failed) acceptor.set_option(asio::socket_base::reuse_address(true), failed);
  if (!failed) acceptor.bind(endpoint, failed);
  if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (failed)
    return Error{Errc::device,
                 fmt::format("{}: cannot be listened on: {}", where, failed.message())};
  own.port = acceptor.local_endpoint().port();
  state->shared.gate = {own.token, address.to_string(), own.port};
  return std::unique_ptr<Server>(new Server(std::move(state)));
}

std::uint16_t Server::port() const {
  return state_->shared.options.port;
}

void Server::run(const std::function<bool()>& ended) {
  state_->accept();
  state_->watch(ended);
  state_->context.run();
  state_->shared.workers.join();
}

}  // namespace proofmass::serve
