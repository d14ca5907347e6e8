#pragma once

#include <cstddef>
#include <string>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// A figure as a person would write it: six digits at most.
[[nodiscard]] std::string in_words(double figure);

/// "once", "3 times"
[[nodiscard]] std::string times(std::size_t count);

/// Where samples stand: "line 12", "lines 12, 40, 41 and 7 more"; samples from 0 where a format
/// has no lines (first_line 0).
[[nodiscard]] std::string places(View<std::size_t> samples, std::size_t first_line);

}  // namespace proofmass::io
