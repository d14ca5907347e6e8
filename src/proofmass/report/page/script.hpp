#pragma once

#include <string_view>

namespace proofmass::report {

/// Zoom, readout and legend toggles of the figures of a page (SVG by svg() of page/figure.hpp):
/// they work on the shapes that are drawn, so the page carries no data twice. Without a script, and
/// on paper, the figures are as drawn.
[[nodiscard]] std::string_view page_script();

/// Style of what the script adds.
[[nodiscard]] std::string_view page_script_css();

}  // namespace proofmass::report
