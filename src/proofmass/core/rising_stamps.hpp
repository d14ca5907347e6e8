#pragma once

#include "proofmass/core/recording.hpp"

namespace proofmass {

/// The recording without the samples whose time does not exceed all earlier times. Motion estimates
/// need this, because two measurements at the same time have no order.
[[nodiscard]] Recording with_rising_stamps(const Recording& recording);

}  // namespace proofmass
