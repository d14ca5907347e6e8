#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace proofmass::app {

/// Text for a terminal with numbers that other programs can parse (hyphen as minus, no spaces
/// inside numbers); only ASCII with `ascii`. Columns separated by two blanks or more stay aligned.
[[nodiscard]] std::string plain_text(std::string_view text, bool ascii);

/// Lines longer than `width` continue below their last column, or indented by two blanks.
[[nodiscard]] std::string wrapped_text(std::string_view text, std::size_t width);

/// plain_text() for the locale of the terminal (LC_ALL, LC_CTYPE or LANG); UTF-8 if none is set.
[[nodiscard]] std::string terminal_text(std::string_view text);

/// terminal_text(), wrapped if standard output is a terminal.
[[nodiscard]] std::string shown_text(std::string_view text);

}  // namespace proofmass::app
