#include "proofmass/serve/http/gate.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <sys/random.h>

namespace proofmass::serve {
namespace {

using boost::asio::ip::make_address;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

// "[::1]:8080" as "::1" and "8080"; the port of HTTP where none is named.
std::pair<std::string, std::string> host_and_port(std::string_view text) {
  const std::size_t bracket = text.starts_with('[') ? text.find(']') : std::string_view::npos;
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  std::string_view host = text.substr(0, colon);
  if (bracket != std::string_view::npos && host.size() == bracket + 1)
    host = host.substr(1, bracket - 1);
  return {lower(host),
          colon == std::string_view::npos ? "80" : std::string(text.substr(colon + 1))};
}

std::optional<boost::asio::ip::address> address_of(std::string_view text) {
  boost::system::error_code failed;
  const auto address = make_address(std::string(text), failed);
  return failed ? std::nullopt : std::optional(address);
}

std::string token_of(const RequestHead& head, const Target& target) {
  constexpr std::string_view scheme = "Bearer ";
  if (head.authorization && head.authorization->starts_with(scheme))
    return head.authorization->substr(scheme.size());
  return target.find("token").value_or("");
}

}  // namespace

Result<std::string> random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return Error{Errc::device, fmt::format("no random numbers: {}", std::strerror(errno))};
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

bool same_secret(std::string_view given, std::string_view expected) {
  unsigned difference = given.size() == expected.size() ? 0U : 1U;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const char other = given.empty() ? '\0' : given[k % given.size()];
    difference |= static_cast<unsigned char>(other) ^ static_cast<unsigned char>(expected[k]);
  }
  return difference == 0 && !expected.empty();
}

bool is_loopback(std::string_view address) {
  const auto parsed = address_of(address);
  return parsed && parsed->is_loopback();
}

std::string in_link(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

bool is_our_host(const Gate& gate, std::string_view host) {
  const auto [name, port] = host_and_port(host);
  if (port != std::to_string(gate.port)) return false;
  const auto own = address_of(gate.address);
  if (name == "localhost") return own && (own->is_loopback() || own->is_unspecified());
  const auto named = address_of(name);
  if (!named || !own) return false;
  return own->is_unspecified() || *named == *own;
}

std::optional<Response> refusal(const Gate& gate, const RequestHead& head) {
  if (!head.host || !is_our_host(gate, *head.host))
    return error_response(421, "this Host is not served here: open the link that serve printed");
  constexpr std::string_view scheme = "http://";
  if (head.origin && !(head.origin->starts_with(scheme) &&
                       is_our_host(gate, std::string_view(*head.origin).substr(scheme.size()))))
    return error_response(403, "requests of other pages are refused");
  const auto target = parse_target(head.target);
  if (!target) return error_response(400, target.error().message);
  constexpr std::array<std::string_view, 4> methods{"GET", "POST", "PUT", "DELETE"};
  if (std::ranges::find(methods, head.method) == methods.end())
    return error_response(405, "expected GET, POST, PUT or DELETE");
  if (!same_secret(token_of(head, *target), gate.token))
    return error_response(403, "no token, or another: open the link that serve printed");
  return std::nullopt;
}

}  // namespace proofmass::serve
