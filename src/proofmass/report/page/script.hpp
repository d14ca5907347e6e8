#pragma once

#include <string_view>

namespace proofmass::report {

/// Zoom, readout and legend toggles for the figures of a page (SVG by svg() of page/figure.hpp).
/// The script works on the drawn shapes, so the page contains no second copy of the data. Without a
/// script, and in print, the figures remain as drawn.
[[nodiscard]] std::string_view page_script();

/// Style of the elements that the script adds.
[[nodiscard]] std::string_view page_script_css();

}  // namespace proofmass::report
