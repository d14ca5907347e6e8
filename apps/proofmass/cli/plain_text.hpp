#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace proofmass::app {

/// Text for a terminal: figures that other programs read as they are (a hyphen as minus, no spaces
/// inside numbers), and ASCII alone with `ascii`. Columns that two blanks or more separate stay
/// aligned.
[[nodiscard]] std::string plain_text(std::string_view text, bool ascii);

/// Lines that are longer than `width` go on below their last column, or two blanks further in.
[[nodiscard]] std::string wrapped_text(std::string_view text, std::size_t width);

/// plain_text() for the terminal's locale, as LC_ALL, LC_CTYPE or LANG says; UTF-8 where none does.
[[nodiscard]] std::string terminal_text(std::string_view text);

/// terminal_text(), wrapped to the terminal where standard output is one.
[[nodiscard]] std::string shown_text(std::string_view text);

}  // namespace proofmass::app
