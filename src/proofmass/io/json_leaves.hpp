#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A leaf of a JSON document.
struct JsonLeaf {
  std::string_view path;                ///< "acc.x"; numbers from 0 in lists: "points.3.x"
  double figure = 0.0;                  ///< NaN for a text; true is 1
  std::optional<std::int64_t> whole{};  ///< the exact number, if written as an integer
  std::optional<std::string_view> text{};
};

/// Visits the numbers, booleans and texts of a document in order, without storing it. Errors:
/// corrupt (not JSON, with the byte; deeper than 32 levels).
[[nodiscard]] Status visit_json(std::string_view document,
                                const std::function<void(const JsonLeaf&)>& visit);

/// A text as a quoted JSON string; invalid UTF-8 is replaced.
[[nodiscard]] std::string json_text(std::string_view text);

}  // namespace proofmass::io
