#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/serve/http/gate.hpp"
#include "proofmass/serve/http/request.hpp"
#include "proofmass/serve/live/frame.hpp"

namespace proofmass::serve {

/// What a peer may take of the server.
struct ServerLimits {
  std::size_t connections = 128;
  std::chrono::milliseconds head{10'000};   ///< silence before and within the head of a request
  std::chrono::milliseconds stall{30'000};  ///< a body that stops coming, an answer not taken
  std::uint32_t head_bytes = 16U << 10;
  std::uint64_t body_bytes = std::uint64_t{1} << 20;
  std::uint64_t upload_bytes = std::uint64_t{16} << 30;  ///< limit of a PUT
  double requests_per_s = 400.0;  ///< all peers together, after a burst of as many
  std::size_t sockets = 32;       ///< WebSockets, besides the connections
  std::size_t socket_message_bytes = 4096;
  /// Limits of each WebSocket, beyond which the oldest frames are left out.
  std::size_t socket_queue_bytes = std::size_t{16} << 20, socket_queue_frames = 64;
};

/// Takes a message of a WebSocket, on the network's thread; an error closes it.
using LiveHandler =
    std::function<Status(const std::shared_ptr<LiveListener>& from, std::string_view message)>;

inline constexpr std::string_view live_path = "/api/live/socket";

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: a free one
  std::string token{};
  std::string upload_folder{};  ///< for the temporary file of a PUT
  std::string page{};  ///< what GET / answers, also without a token: it shows nothing by itself
  std::string content_security_policy{};
  LiveHandler live{};  ///< of the WebSockets at live_path; empty: there are none
  ServerLimits limits{};
};

/// Answers a request that has passed the gate. Called from several threads at once.
using Handler = std::function<Response(const Request&)>;

/// An HTTP server of one address, for few users. Every request passes refusal() before its body is
/// read. Where all connections are taken, a new one takes the place of the one that has waited
/// longest for a request. Answers carry no CORS headers. At live_path it serves WebSockets.
class Server {
 public:
  /// Errors: device (the address cannot be listened on: no such address, the port is taken).
  [[nodiscard]] static Result<std::unique_ptr<Server>> listen(ServerOptions options,
                                                              Handler handler);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server();

  [[nodiscard]] std::uint16_t port() const;
  /// Serves until `ended` says so, which is asked ten times a second; then all connections are
  /// closed.
  void run(const std::function<bool()>& ended);

 private:
  struct State;
  explicit Server(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::serve
