#pragma once

#include "proofmass/report/fields.hpp"
#include "proofmass/sensor/figure_list.hpp"

namespace proofmass::report {

/// Identifies a figure of a sensor file: "section", "key" and, if any, "axis".
[[nodiscard]] Fields slot_fields(const sensor::FigureSlot& slot);

}  // namespace proofmass::report
