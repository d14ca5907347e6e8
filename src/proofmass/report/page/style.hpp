#pragma once

#include <string_view>

namespace proofmass::report {

/// Style of a page for dark and light screens, print and phones, in the colours of figure_css().
[[nodiscard]] std::string_view page_css();

}  // namespace proofmass::report
