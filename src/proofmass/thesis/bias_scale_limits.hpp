#pragma once

#include <vector>

#include "proofmass/thesis/item.hpp"

// What a bias of 19.68 mg and a scale-factor error of 0.0041 % ask of a tumble.
namespace proofmass::thesis {

/// How long the sensor must stand in each of four positions for a scale-factor error to lie 1.96
/// standard deviations off zero in white noise: std(K1)/K1 = ND/(√(2T) √2 g).
[[nodiscard]] double white_dwell_s(double scale_error);

/// What is found for the scale factor's error in Halifax if gravity is taken to be the standard
/// one.
[[nodiscard]] double standard_gravity_scale_error();

[[nodiscard]] std::vector<Finding> limit_findings();

/// What moves bias and scale factor, and by how much.
[[nodiscard]] report::Table limits_table(double gravity_mps2);

}  // namespace proofmass::thesis
