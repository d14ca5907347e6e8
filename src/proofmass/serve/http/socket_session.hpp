#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <memory>

#include "proofmass/serve/http/session.hpp"
#include "proofmass/serve/live/frame.hpp"

namespace proofmass::serve {

/// A WebSocket (RFC 6455) to one browser, on the network's thread. Frames wait in a queue: beyond
/// its limit the oldest that may be left out are, and their number goes with the next one. A
/// browser that takes nothing for a while, or asks too often, loses the connection. take() may be
/// called from any thread.
class SocketSession : public LiveListener {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  /// Answers the request, which has passed the gate, and serves.
  static std::shared_ptr<SocketSession> begin(boost::beast::tcp_stream stream,
                                              Request request,
                                              SessionsShared& shared);
  virtual void close() = 0;
};

}  // namespace proofmass::serve
