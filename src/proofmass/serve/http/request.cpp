#include "proofmass/serve/http/request.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proofmass/core/utf8.hpp"

namespace proofmass::serve {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

Result<std::string> decoded(std::string_view text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    char c = text[k];
    if (c == '%') {
      const int high = k + 2 < text.size() ? hex_digit(text[k + 1]) : -1;
      const int low = high < 0 ? -1 : hex_digit(text[k + 2]);
      if (low < 0) return Error{Errc::invalid_argument, "target: expected two hex digits after %"};
      c = static_cast<char>(16 * high + low);
      k += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      return Error{Errc::invalid_argument, "target: holds a control character"};
    out += c;
  }
  if (!is_utf8(out)) return Error{Errc::invalid_argument, "target: is not UTF-8"};
  return out;
}

}  // namespace

std::optional<std::string> Target::find(std::string_view name) const {
  const auto found = std::ranges::find(query, name, [](const auto& one) { return one.first; });
  return found == query.end() ? std::nullopt : std::optional(found->second);
}

Result<Target> parse_target(std::string_view text) {
  if (!text.starts_with('/'))
    return Error{Errc::invalid_argument, "target: expected one that begins with /"};
  if (text.size() > most_target_bytes) return Error{Errc::invalid_argument, "target: too long"};
  text = text.substr(0, text.find('#'));
  const std::size_t mark = text.find('?');
  auto path = decoded(text.substr(0, mark));
  if (!path) return path.error();
  Target target{std::move(path).value()};
  std::string_view rest = mark == std::string_view::npos ? "" : text.substr(mark + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string_view pair = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    auto name = decoded(pair.substr(0, equals));
    if (!name) return name.error();
    auto value = decoded(pair.substr(std::min(equals + 1, pair.size())));
    if (!value) return value.error();
    target.query.emplace_back(std::move(name).value(), std::move(value).value());
  }
  return target;
}

Response error_response(unsigned status, std::string_view message) {
  const nlohmann::ordered_json body{{"error", std::string(message)}};
  return {status, body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

}  // namespace proofmass::serve
