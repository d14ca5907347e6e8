#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/serve/http/request.hpp"

namespace proofmass::serve {

/// 128 random bits of the operating system, as 32 hex digits. Errors: device.
[[nodiscard]] Result<std::string> random_token();

/// Takes the same time wherever the two differ.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view expected);

/// What a request needs to be answered.
struct Gate {
  std::string token;
  std::string address;  ///< that the server listens on: "127.0.0.1", "::1", "0.0.0.0"
  std::uint16_t port = 0;
};

/// Whether the Host header names this server: the address it listens on, or localhost where that
/// is a loopback address. Where it listens on all addresses any literal address is taken, but no
/// other name: a name can be made to resolve to this machine (DNS rebinding), an address cannot.
[[nodiscard]] bool is_our_host(const Gate& gate, std::string_view host);

/// Whether an address is reached from this machine alone.
[[nodiscard]] bool is_loopback(std::string_view address);

/// An address as it stands in a link: [::1] for ::1.
[[nodiscard]] std::string in_link(const std::string& address);

/// Why a request is refused, or nothing: a Host that is not ours 421, a foreign Origin 403, a
/// target that cannot be parsed 400, an unknown method 405, no token or another 403. The token is
/// the query's `token` or the header "Authorization: Bearer TOKEN".
[[nodiscard]] std::optional<Response> refusal(const Gate& gate, const RequestHead& head);

}  // namespace proofmass::serve
