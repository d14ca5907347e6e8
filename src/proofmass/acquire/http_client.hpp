#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// What a web server answered.
struct HttpAnswer {
  unsigned status = 0;
  std::string body;
};

/// What is asked of a server that may be slow, silent or out to fill the memory.
struct HttpLimits {
  std::chrono::milliseconds answer{10'000};  ///< from the question to the last byte of the answer
  std::size_t body_bytes = std::size_t{64} << 20;
};

/// Asks one web server, one question at a time, over a connection that it keeps open. Plain HTTP.
class HttpClient {
 public:
  /// Connects with the first question. `server` has a port.
  explicit HttpClient(HostPort server, HttpLimits limits = {});
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;
  ~HttpClient();

  [[nodiscard]] bool is_waiting() const;
  /// GET of a target such as "/get?a=1". Not while it is waiting for an answer.
  void ask(std::string target);
  /// The answer, or nullopt if it is not there within `patience`: ask this again.
  /// Errors: device (no such host, refused, broken off, too slow, too long).
  [[nodiscard]] Result<std::optional<HttpAnswer>> answer(std::chrono::milliseconds patience);

 private:
  struct Connection;
  HostPort server_;
  HttpLimits limits_;
  std::unique_ptr<Connection> connection_;  ///< made anew after each failure
};

}  // namespace proofmass::acquire
