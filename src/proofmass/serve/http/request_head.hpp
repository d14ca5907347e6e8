#pragma once

#include <boost/beast/http/message.hpp>
#include <iterator>
#include <string>

#include "proofmass/serve/http/request.hpp"

namespace proofmass::serve {

/// A header's value; of one that occurs several times, all of them, which matches nothing.
template <class Header>
std::optional<std::string> header_value(const Header& header, boost::beast::http::field name) {
  const auto [first, last] = header.equal_range(name);
  if (first == last) return std::nullopt;
  std::string value;
  for (auto one = first; one != last; ++one) {
    if (one != first) value += ", ";
    value.append(one->value().data(), one->value().size());
  }
  return value;
}

/// What the gate looks at.
template <class Header>
RequestHead head_of(const Header& header) {
  using boost::beast::http::field;
  return {.method = std::string(header.method_string()),
          .target = std::string(header.target()),
          .host = header_value(header, field::host),
          .origin = header_value(header, field::origin),
          .authorization = header_value(header, field::authorization)};
}

}  // namespace proofmass::serve
