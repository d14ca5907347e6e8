#pragma once

#include <cstdint>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/thesis/item.hpp"

namespace proofmass::thesis {

/// Section 6.2: whether the filter's output can drive the motor, on the simulated drive. Errors: as
/// study_servo().
[[nodiscard]] Result<std::vector<Item>> servo_items(std::uint64_t seed,
                                                    const Progress& report_progress);

}  // namespace proofmass::thesis
