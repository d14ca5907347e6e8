#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Response of a web server.
struct HttpAnswer {
  unsigned status = 0;
  std::string body;
};

/// Limits for a server that may be slow, silent or malicious.
struct HttpLimits {
  std::chrono::milliseconds answer{10'000};  ///< from the request to the last byte of the response
  std::size_t body_bytes = std::size_t{64} << 20;
};

/// Client of one web server, one request at a time, over a persistent connection. Plain HTTP.
class HttpClient {
 public:
  /// Connects with the first request. `server` has a port.
  explicit HttpClient(HostPort server, HttpLimits limits = {});
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;
  ~HttpClient();

  [[nodiscard]] bool is_waiting() const;
  /// GET of a target such as "/get?a=1". Not while a response is pending.
  void ask(const std::string& target);
  /// The response, or nullopt if it has not arrived within `patience`: call again.
  /// Errors: device (no such host, refused, connection lost, too slow, too long).
  [[nodiscard]] Result<std::optional<HttpAnswer>> answer(std::chrono::milliseconds patience);

 private:
  struct Connection;
  HostPort server_;
  HttpLimits limits_;
  std::unique_ptr<Connection> connection_;  ///< replaced after each failure
};

}  // namespace proofmass::acquire
