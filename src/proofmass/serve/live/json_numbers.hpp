#pragma once

#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <string>
#include <vector>

namespace proofmass::serve {

/// A number as JSON with so many significant digits; null if it is not finite.
inline void append_number(std::string& text, double value, int digits) {
  if (std::isfinite(value))
    fmt::format_to(std::back_inserter(text), "{:.{}g}", value, digits);
  else
    text += "null";
}

/// Numbers as a JSON array.
inline void append_numbers(std::string& text, const std::vector<double>& values, int digits) {
  text += '[';
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) text += ',';
    append_number(text, values[k], digits);
  }
  text += ']';
}

/// An array of arrays.
inline void append_lists(std::string& text,
                         const std::vector<std::vector<double>>& lists,
                         int digits) {
  text += '[';
  for (std::size_t k = 0; k < lists.size(); ++k) {
    if (k > 0) text += ',';
    append_numbers(text, lists[k], digits);
  }
  text += ']';
}

}  // namespace proofmass::serve
