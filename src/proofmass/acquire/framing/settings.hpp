#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/acquire/framing/plan.hpp"
#include "proofmass/core/units.hpp"

// Settings that refer to columns: time=, counter=, unit=, scale=.
namespace proofmass::acquire {

/// By its heading or its name without the unit, ignoring case.
[[nodiscard]] std::optional<std::size_t> find_field(const std::vector<RowField>& fields,
                                                    std::string_view name);
/// "time=tt: there is no such column of figures; there are t, ax, ay, az"
[[nodiscard]] Error no_such_field(const RowEvidence& rows,
                                  std::string_view setting,
                                  std::string_view name);

/// "0.5" for all columns, or "x:0.5,y:2" for some.
struct PerColumn {
  std::string all{};
  std::vector<std::pair<std::size_t, std::string>> some{};
  [[nodiscard]] std::string of(std::size_t field) const;  ///< empty if none is given
};
/// Errors: invalid_argument (a column that does not exist).
[[nodiscard]] Result<PerColumn> per_column(std::string_view text,
                                           std::string_view setting,
                                           const RowEvidence& rows);
/// Errors: invalid_argument.
[[nodiscard]] Result<Unit> unit_setting(std::string_view text);
[[nodiscard]] Result<double> scale_setting(std::string_view text);

/// "us"; the word for a clock unit.
[[nodiscard]] std::string_view unit_word(std::int64_t unit_ns);
/// For "s", "ms", "us", "ns"; nullopt for others, and for quantities other than time.
[[nodiscard]] std::optional<std::int64_t> clock_unit_ns(const Unit& unit);

}  // namespace proofmass::acquire
