#pragma once

#include "proofmass/core/recording.hpp"

namespace proofmass {

/// The recording without the samples whose time is not above that of all before: for estimates of a
/// motion, in which two readings of one instant have no order.
[[nodiscard]] Recording with_rising_stamps(const Recording& recording);

}  // namespace proofmass
