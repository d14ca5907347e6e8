#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/uncertainty/type_b.hpp"
#include "proofmass/calibrate/uncertainty_budget.hpp"

// Uncertainty budget of a multi-position calibration.
namespace proofmass::calibrate {

/// "bias x" … "scale z", "misalignment yz", "misalignment zy", "misalignment zx": the order of
/// MultiPosition::covariance.
[[nodiscard]] const std::array<std::string, 9>& parameter_names();

/// Adds the user's contributions to the fit's own shares: covariance and standard deviations grow.
/// reading_unit: "m/s^2", "V" or "counts". A bias in m/s^2 is converted by the scale if the output
/// has another unit; a contribution to a parameter that was not estimated is ignored. Errors:
/// invalid_argument (a target other than bias, scale, misalignment; an incompatible unit). The fit
/// is then unchanged.
[[nodiscard]] Status add_type_b(MultiPosition& fit,
                                View<TypeB> lines,
                                std::string_view reading_unit);

/// A budget for each estimated parameter, in their order, of a fit to which `lines` have not been
/// added: one line for each non-zero share, one for each of `lines` that acts on it. Errors: those
/// of add_type_b.
[[nodiscard]] Result<std::vector<UncertaintyBudget>> budget_of(const MultiPosition& fit,
                                                               View<TypeB> lines,
                                                               std::string_view reading_unit);

}  // namespace proofmass::calibrate
