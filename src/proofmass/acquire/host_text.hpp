#pragma once

#include <string>
#include <string_view>

#include "proofmass/acquire/source_uri.hpp"

namespace proofmass::acquire {

/// "phone.local:8080", "[::1]:8080": as URLs write it.
[[nodiscard]] std::string text_of(const HostPort& place);

/// A name or a value as a URL's query carries it: all but letters, figures and "-._~" as %41.
/// Source: RFC 3986, 2.3.
[[nodiscard]] std::string query_text(std::string_view text);

}  // namespace proofmass::acquire
