#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// A text that may be shown anywhere: UTF-8 whatever it was, on one line, with blanks in place of
/// what a terminal obeys: control characters (C0, C1), line separators, and those that turn the
/// direction of writing. What is text already is returned as it is.
[[nodiscard]] std::string clean_text(std::string_view text);

/// clean_text() of all names, labels and notes of a recording.
void clean_texts(Recording& recording);

/// A text that a file gives, for a name or a note: clean_text() without the blanks around it, cut
/// behind 120 bytes.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace proofmass::io
