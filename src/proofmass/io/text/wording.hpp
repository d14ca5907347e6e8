#pragma once

#include <cstddef>
#include <string>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// A number for display: at most six digits.
[[nodiscard]] std::string in_words(double figure);

/// "once", "3 times"
[[nodiscard]] std::string times(std::size_t count);

/// Positions of samples: "line 12", "lines 12, 40, 41 and 7 more"; samples from 0 if a format has
/// no lines (first_line 0).
[[nodiscard]] std::string places(View<std::size_t> samples, std::size_t first_line);

}  // namespace proofmass::io
