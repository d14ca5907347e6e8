#include "proofmass/acquire/source_uri.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace proofmass::acquire {
namespace {

bool is_scheme(std::string_view text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) != 0; });
}

Result<std::string> decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    unsigned byte = 0;
    const char* const from = text.data() + i + 1;
    const auto [end, problem] = i + 2 < text.size()
                                    ? std::from_chars(from, from + 2, byte, 16)
                                    : std::from_chars_result{from, std::errc::invalid_argument};
    if (problem != std::errc{} || end != from + 2)
      return invalid(fmt::format("{}: expected two hexadecimal digits after %", text));
    out += static_cast<char>(byte);
    i += 2;
  }
  return out;
}

}  // namespace

Error invalid(std::string message) {
  return {Errc::invalid_argument, std::move(message)};
}

Result<SourceUri> SourceUri::parse(std::string_view text) {
  SourceUri uri;
  uri.text_ = text == "-" ? "stdin:" : text;
  const std::string_view whole = uri.text_;
  const std::size_t colon = whole.find(':');
  if (colon == std::string_view::npos || !is_scheme(whole.substr(0, colon)))
    return Error{Errc::invalid_argument,
                 fmt::format("{}: expected a source such as sim:, serial:/dev/ttyACM0 or "
                             "iio:ip:HOST",
                             text),
                 {Advice{"list"}}};
  uri.scheme_ = whole.substr(0, colon);
  std::string_view rest = whole.substr(colon + 1);
  const std::size_t mark = rest.find('?');
  std::string_view query = mark == std::string_view::npos ? "" : rest.substr(mark + 1);
  rest = rest.substr(0, mark);
  if (rest.starts_with("//")) rest.remove_prefix(2);
  const auto place = decoded(rest);
  if (!place) return place.error();
  uri.place_ = *place;
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos || equals == 0)
      return invalid(fmt::format("{}: expected key=value in place of \"{}\"", text, pair));
    const auto value = decoded(pair.substr(equals + 1));
    if (!value) return value.error();
    const std::string key(pair.substr(0, equals));
    if (std::ranges::any_of(uri.pairs_, [&](const auto& other) { return other.first == key; }))
      return invalid(fmt::format("{}: {} is there twice", text, key));
    uri.pairs_.emplace_back(key, *value);
  }
  return uri;
}

std::optional<std::string> SourceUri::value(std::string_view key) {
  if (std::ranges::find(asked_, key) == asked_.end()) asked_.emplace_back(key);
  for (const auto& [name, value] : pairs_)
    if (name == key) return value;
  return std::nullopt;
}

Result<std::optional<double>> SourceUri::number(std::string_view key, double above) {
  const auto text = value(key);
  if (!text) return std::optional<double>();
  double number = 0.0;
  const char* const end = text->data() + text->size();
  const auto [stop, problem] = std::from_chars(text->data(), end, number);
  if (problem != std::errc{} || stop != end || !std::isfinite(number) || !(number > above))
    return invalid(fmt::format("{}={}: expected a number above {}", key, *text, above));
  return std::optional(number);
}

Result<std::optional<std::uint64_t>> SourceUri::whole(std::string_view key,
                                                      std::uint64_t least,
                                                      std::uint64_t most) {
  const auto text = value(key);
  if (!text) return std::optional<std::uint64_t>();
  std::uint64_t number = 0;
  const char* const end = text->data() + text->size();
  const auto [stop, problem] = std::from_chars(text->data(), end, number);
  if (problem != std::errc{} || stop != end || number < least || number > most)
    return invalid(
        fmt::format("{}={}: expected a whole number from {} to {}", key, *text, least, most));
  return std::optional(number);
}

Result<std::string> SourceUri::choice(std::string_view key,
                                      const std::vector<std::string_view>& words) {
  const auto text = value(key);
  if (!text) return std::string(words.front());
  if (std::ranges::find(words, std::string_view(*text)) == words.end())
    return invalid(fmt::format("{}={}: expected {}", key, *text, fmt::join(words, ", ")));
  return *text;
}

Status SourceUri::nothing_unknown() const {
  for (const auto& [key, value] : pairs_)
    if (std::ranges::find(asked_, key) == asked_.end()) {
      if (asked_.empty()) return invalid(fmt::format("{}: {}: takes no settings", key, scheme_));
      return invalid(fmt::format("{}: no such setting of {}:, which has {}", key, scheme_,
                                 fmt::join(asked_, ", ")));
    }
  return Done{};
}

Result<HostPort> parse_host_port(std::string_view text) {
  HostPort out;
  std::string_view port;
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == std::string_view::npos) return invalid(fmt::format("{}: expected a ]", text));
    out.host = text.substr(1, close - 1);
    port = text.substr(close + 1);
  } else {
    const std::size_t colon = text.rfind(':');
    out.host = text.substr(0, colon);
    if (colon != std::string_view::npos) port = text.substr(colon);
  }
  if (out.host.empty()) return invalid(fmt::format("\"{}\": expected HOST or HOST:PORT", text));
  if (port.empty()) return out;
  unsigned short number = 0;
  const char* const end = port.data() + port.size();
  const auto [stop, problem] = std::from_chars(port.data() + 1, end, number);
  if (port.front() != ':' || problem != std::errc{} || stop != end || number == 0)
    return invalid(fmt::format("{}: expected a port from 1 to 65535 after the host", text));
  out.port = number;
  return out;
}

}  // namespace proofmass::acquire
