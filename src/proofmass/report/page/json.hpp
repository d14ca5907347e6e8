#pragma once

#include <string>

#include "proofmass/report/page/page.hpp"

namespace proofmass::report {

/// The content of the page as JSON, for programs that draw it themselves: conclusion, key figures,
/// notes, and sections with their tables and with the axes, curves and bands of every plot as
/// numbers, thinned as in the page (page/thinning.hpp). A value that is not finite, which breaks a
/// curve, is null.
/// {"proofmass", "verb", "title", "inputs", "conclusion", "key_figures": [{"label", "value"}],
/// "notes": [{"severity", "text"}], "sections": [{"heading", "id", "paragraphs", "points", "sides",
/// "tables", "figures", "parts"}]}
[[nodiscard]] std::string page_json(const Page& page);

}  // namespace proofmass::report
