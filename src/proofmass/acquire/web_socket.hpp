#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

struct WebSocketLimits {
  std::chrono::milliseconds opening{10'000};
  /// Of a peer that neither sends nor answers a ping.
  std::chrono::milliseconds silence{10'000};
  std::size_t message_bytes = std::size_t{64} << 10;
};

/// Listens to a WebSocket (RFC 6455) without TLS; answers pings by itself while it is read.
class WebSocket {
 public:
  /// Begins to connect to ws://server/target; `server` has a port.
  WebSocket(HostPort server, std::string target, WebSocketLimits limits = {});
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;
  ~WebSocket();

  [[nodiscard]] bool is_open() const;
  /// The next message, valid until the next reading; nullopt if there is none within `patience`.
  /// Errors: device (cannot be reached, no WebSocket, too long a message, silent; closed: with the
  /// peer's code and reason). There is nothing to be read after one.
  [[nodiscard]] Result<std::optional<std::string_view>> read(std::chrono::milliseconds patience);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace proofmass::acquire
