#pragma once

#include "proofmass/core/recording.hpp"

namespace proofmass {

/// The recording without the samples whose time does not exceed all earlier times. Motion estimates
/// need this, because two measurements at the same time have no order.
[[nodiscard]] Recording with_rising_stamps(const Recording& recording);

/// The recording without rows that repeat the one before, stamp and values, with a warning that
/// counts them: a logger wrote them twice. Unchanged if rows of one stamp differ (more than one in
/// ten), or are as similar as those of different stamps (a coarse sensor at rest with one stamp for
/// several samples).
[[nodiscard]] Recording without_repeated_rows(Recording recording);

}  // namespace proofmass
