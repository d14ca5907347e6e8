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
  /// Timeout for a peer that neither sends nor answers a ping.
  std::chrono::milliseconds silence{10'000};
  std::size_t message_bytes = std::size_t{64} << 10;
};

/// Receives from a WebSocket (RFC 6455) without TLS; answers pings while it is read.
class WebSocket {
 public:
  /// Starts to connect to ws://server/target; `server` has a port.
  WebSocket(HostPort server, std::string target, WebSocketLimits limits = {});
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;
  ~WebSocket();

  [[nodiscard]] bool is_open() const;
  /// The next message, valid until the next call; nullopt if there is none within `patience`.
  /// Errors: device (unreachable, not a WebSocket, message too long, silent; closed: with the
  /// peer's code and reason). After an error nothing more can be read.
  [[nodiscard]] Result<std::optional<std::string_view>> read(std::chrono::milliseconds patience);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace proofmass::acquire
