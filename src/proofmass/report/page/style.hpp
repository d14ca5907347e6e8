#pragma once

#include <string_view>

namespace proofmass::report {

/// How a page looks, on either ground, on paper and on a phone; in the colours of figure_css().
[[nodiscard]] std::string_view page_css();

}  // namespace proofmass::report
