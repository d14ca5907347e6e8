#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// "scheme:place?key=value&key=value": the place may begin with "//"; in a value %41 is a byte in
/// hexadecimal, and '+' a plus. "-" is "stdin:".
/// Source: RFC 3986, reduced to what is needed here.
class SourceUri {
 public:
  /// Errors: invalid_argument (no scheme, a key twice or without '=', a bad %).
  [[nodiscard]] static Result<SourceUri> parse(std::string_view text);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& scheme() const { return scheme_; }
  [[nodiscard]] const std::string& place() const { return place_; }  ///< without "//", decoded

  /// Value of a key; each key that is requested counts as known.
  [[nodiscard]] std::optional<std::string> value(std::string_view key);
  /// The value as a number. Errors: invalid_argument ("rate=fast: expected a number above 0").
  [[nodiscard]] Result<std::optional<double>> number(std::string_view key, double above);
  /// The value as a whole number. Errors: invalid_argument ("axes=4: expected a whole number from 2
  /// to 3").
  [[nodiscard]] Result<std::optional<std::uint64_t>> whole(std::string_view key,
                                                           std::uint64_t least,
                                                           std::uint64_t most);
  /// The value as one of several words; the first if absent. Errors: invalid_argument.
  [[nodiscard]] Result<std::string> choice(std::string_view key,
                                           const std::vector<std::string_view>& words);
  /// Call after all keys of the scheme were requested. Errors: invalid_argument (an unknown key;
  /// the message lists the known ones).
  [[nodiscard]] Status nothing_unknown() const;

 private:
  std::string text_, scheme_, place_;
  std::vector<std::pair<std::string, std::string>> pairs_;
  std::vector<std::string> asked_;
};

/// "host", "host:port", "[::1]:port".
struct HostPort {
  std::string host;
  std::optional<unsigned short> port;
};

/// An invalid_argument error.
[[nodiscard]] Error invalid(std::string message);

/// Errors: invalid_argument.
[[nodiscard]] Result<HostPort> parse_host_port(std::string_view text);

}  // namespace proofmass::acquire
