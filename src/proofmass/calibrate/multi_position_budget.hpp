#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/type_b.hpp"
#include "proofmass/calibrate/uncertainty_budget.hpp"

// Where the uncertainty of a multi-position calibration comes from.
namespace proofmass::calibrate {

/// "bias x" … "scale z", "misalignment yz", "misalignment zy", "misalignment zx": the order of
/// MultiPosition::covariance.
[[nodiscard]] const std::array<std::string, 9>& parameter_names();

/// Puts what the user states beside the fit's own shares: covariance and standard deviations grow.
/// reading_unit: "m/s^2", "V" or "counts". A bias in m/s^2 of a reading that is not is brought to
/// it by the scale; a contribution to a parameter that was not estimated is left out.
/// Errors: invalid_argument (a target that is none of bias, scale, misalignment; a unit that does
/// not go with the reading). The fit is then as it was.
[[nodiscard]] Status add_type_b(MultiPosition& fit,
                                View<TypeB> lines,
                                std::string_view reading_unit);

/// A budget of each parameter that was estimated, in their order, of a fit to which `lines` have
/// not been added: one line for each share that is not zero, one for each of `lines` that acts on
/// it.
/// Errors: those of add_type_b.
[[nodiscard]] Result<std::vector<UncertaintyBudget>> budget_of(const MultiPosition& fit,
                                                               View<TypeB> lines,
                                                               std::string_view reading_unit);

}  // namespace proofmass::calibrate
