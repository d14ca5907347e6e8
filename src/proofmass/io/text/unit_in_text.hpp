#pragma once

#include <string>
#include <string_view>

namespace proofmass::io {

/// A unit as written after names: "seconds since 1970-01-01" is "s"; empty if it is not a unit.
[[nodiscard]] std::string unit_symbol(std::string_view text);

/// The unit given in a text directly after a name: "`acc` in m/s²," or "acc [g]"; empty if none.
[[nodiscard]] std::string unit_in_text(std::string_view text, std::string_view name);

}  // namespace proofmass::io
