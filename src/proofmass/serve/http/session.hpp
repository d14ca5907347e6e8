#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <list>
#include <memory>
#include <utility>

#include "proofmass/serve/http/token_bucket.hpp"
#include "proofmass/serve/server.hpp"

namespace proofmass::serve {

class Session;
class SocketSession;

/// What the connections of a server have in common. Used by the network's thread alone, but for
/// `handler`, which runs on `workers`.
struct SessionsShared {
  SessionsShared(ServerOptions given, Handler answers)
      : options(std::move(given)),
        handler(std::move(answers)),
        requests(options.limits.requests_per_s),
        refusals(options.limits.requests_per_s) {}

  /// Serves a connection, in the place of the longest waiting one where there is no room.
  void admit(boost::asio::ip::tcp::socket socket);
  void close_all();

  ServerOptions options;
  Handler handler;
  Gate gate{};
  TokenBucket requests, refusals;
  std::list<std::weak_ptr<SocketSession>> sockets{};
  std::list<std::weak_ptr<Session>> sessions{};  ///< the one that began to wait last at the end
  boost::asio::thread_pool workers{4};
};

}  // namespace proofmass::serve
