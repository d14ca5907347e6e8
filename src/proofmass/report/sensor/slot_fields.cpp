#include "proofmass/report/sensor/slot_fields.hpp"

namespace proofmass::report {

Fields slot_fields(const sensor::FigureSlot& slot) {
  Fields fields{
      field::choice("section", slot.section,
                    {"electrical", "calibration", "noise", "drift", "gyroscope", "encoder"}),
      field::text("key", slot.key)};
  if (slot.axis)
    fields.push_back(field::choice("axis", slot.axis_name(), {"x", "y", "z", "yz", "zy", "zx"},
                                   {.meaning = "pair of axes of a misalignment; not present for a "
                                               "figure of the whole sensor"}));
  return fields;
}

}  // namespace proofmass::report
