#pragma once

#include "proofmass/report/fields.hpp"
#include "proofmass/sensor/figure_list.hpp"

namespace proofmass::report {

/// Which figure of a sensor file it is: "section", "key" and, where there is one, "axis".
[[nodiscard]] Fields slot_fields(const sensor::FigureSlot& slot);

}  // namespace proofmass::report
