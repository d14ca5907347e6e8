#pragma once

#include <array>
#include <optional>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// Cross-axis sensitivity in the frame of the calibration, whose z is the sensor's own z axis and
/// whose yz plane contains its y axis, from reading = diag(scale) T⁻¹ f + bias: across x it is
/// (α_yz, α_yz α_zx − α_zy), across y (0, α_zx), across z zero by choice of the frame. Relative to
/// the case a rotation of the frame is added, which is not observable from gravity alone. Absent if
/// misalignment was not fitted. Source: M. A. Lele, thesis (2010), equation 2.2.
[[nodiscard]] std::array<std::optional<CrossAxis>, 3> cross_axis_of(const MultiPosition& fit);

}  // namespace proofmass::calibrate
