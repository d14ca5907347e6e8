#pragma once

#include <string>
#include <string_view>

namespace proofmass::serve {

/// The page of web/dist/page.html, which is compiled in.
[[nodiscard]] std::string_view page_html();

/// A policy under which a browser runs this page's own scripts and styles, by their hashes, and
/// nothing else, and asks no other server.
[[nodiscard]] std::string content_security_policy(std::string_view page);

}  // namespace proofmass::serve
