#pragma once

#include <vector>

#include "proofmass/thesis/item.hpp"

// Tumble accuracy required for a bias of 19.68 mg and a scale-factor error of 0.0041 %.
namespace proofmass::thesis {

/// Duration in each of four positions at which a scale-factor error is 1.96 standard deviations
/// from zero in white noise: std(K1)/K1 = ND/(√(2T) √2 g).
[[nodiscard]] double white_dwell_s(double scale_error);

/// Apparent scale-factor error in Halifax if standard gravity is assumed.
[[nodiscard]] double standard_gravity_scale_error();

[[nodiscard]] std::vector<Finding> limit_findings();

/// Error sources of bias and scale factor, with their size.
[[nodiscard]] report::Table limits_table(double gravity_mps2);

}  // namespace proofmass::thesis
