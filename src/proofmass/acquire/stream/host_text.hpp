#pragma once

#include <string>
#include <string_view>

#include "proofmass/acquire/source_uri.hpp"

namespace proofmass::acquire {

/// "phone.local:8080", "[::1]:8080": as in URLs.
[[nodiscard]] std::string text_of(const HostPort& place);

/// A name or a value for a URL's query: all but letters, digits and "-._~" as %41. Source: RFC
/// 3986, 2.3.
[[nodiscard]] std::string query_text(std::string_view text);

}  // namespace proofmass::acquire
