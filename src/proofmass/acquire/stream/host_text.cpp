#include "proofmass/acquire/stream/host_text.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace proofmass::acquire {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-._~").find(c) != std::string_view::npos;
}

}  // namespace

std::string text_of(const HostPort& place) {
  std::string text =
      place.host.find(':') == std::string::npos ? place.host : fmt::format("[{}]", place.host);
  if (place.port) text += fmt::format(":{}", *place.port);
  return text;
}

std::string query_text(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += is_plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace proofmass::acquire
