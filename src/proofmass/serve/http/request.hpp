#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::serve {

/// Path and query of a request, percent-decoded.
struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query{};

  /// The first value of that name.
  [[nodiscard]] std::optional<std::string> find(std::string_view name) const;
};

inline constexpr std::size_t most_target_bytes = 8192;

/// Errors: invalid_argument (does not begin with "/", longer than most_target_bytes, a broken
/// percent escape, a control character or what is not UTF-8 after decoding).
[[nodiscard]] Result<Target> parse_target(std::string_view text);

/// What is known of a request before its body is read. A header that occurs twice where it must not
/// is kept as one value that nothing matches.
struct RequestHead {
  std::string method;
  std::string target;
  std::optional<std::string> host{}, origin{}, authorization{};
};

struct Request {
  std::string method;
  Target target;
  std::string body;         ///< all methods except PUT
  std::string body_path{};  ///< PUT: a temporary file, removed with the request
};

struct Response {
  unsigned status = 200;
  std::string body;
  std::string content_type = "application/json";
  std::string file_name{};  ///< not empty: the browser saves it under this name
};

/// {"error": message}
[[nodiscard]] Response error_response(unsigned status, std::string_view message);

}  // namespace proofmass::serve
