#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// A text that is safe to display: valid UTF-8, on one line, with blanks instead of characters that
/// control a terminal: control characters (C0, C1), line separators, and changes of the writing
/// direction. Clean text is returned unchanged.
[[nodiscard]] std::string clean_text(std::string_view text);

/// clean_text() of all names, labels and notes of a recording.
void clean_texts(Recording& recording);

/// A text from a file, for a name or a note: clean_text() without surrounding blanks, truncated
/// after 120 bytes.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace proofmass::io
