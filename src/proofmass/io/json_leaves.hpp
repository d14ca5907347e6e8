#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// What stands at a place of a JSON document.
struct JsonLeaf {
  std::string_view path;                ///< "acc.x"; numbers from 0 in lists: "points.3.x"
  double figure = 0.0;                  ///< NaN for a text; true is 1
  std::optional<std::int64_t> whole{};  ///< the figure, where it is written as a whole number
  std::optional<std::string_view> text{};
};

/// Visits the figures, truth values and texts of a document in its order, without holding it.
/// Errors: corrupt (no JSON, with the byte; deeper than 32 levels).
[[nodiscard]] Status visit_json(std::string_view document,
                                const std::function<void(const JsonLeaf&)>& visit);

/// A text as JSON writes it, in its quotes; what is no UTF-8 is replaced.
[[nodiscard]] std::string json_text(std::string_view text);

}  // namespace proofmass::io
