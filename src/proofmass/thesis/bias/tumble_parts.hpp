#pragma once

#include <optional>
#include <string>

#include "proofmass/core/units.hpp"
#include "proofmass/thesis/bias/tumbled_axes.hpp"
#include "proofmass/thesis/item.hpp"

// The parts of section 5.1.2.
namespace proofmass::thesis {

/// Figure 5.4: the manufacturer's specification in each orientation, at 3.3 V.
[[nodiscard]] Item orientation_item();

/// The thesis's printed values of one axis.
struct PrintedAxis {
  std::string name;  ///< "x"
  double at_0_mps2;  ///< the worked readings of 5.1.2
  double at_180_mps2;
  double worked_mps2;  ///< what 5.1.2 prints as their half sum
  double bias_mps2;    ///< table 5.1
  double scale_error;  ///< table 5.1, a fraction
  /// The corresponding axis of the record.
  std::optional<TumbledAxis> TumbledAxes::* place;
};

[[nodiscard]] const PrintedAxis& printed_x();
[[nodiscard]] const PrintedAxis& printed_y();

/// Why an axis is absent: the reason for its rejection, in one sentence.
[[nodiscard]] std::string absent_words(const PrintedAxis& printed, const TumbledAxes& axes);

/// Figure 5.5 or 5.6.
[[nodiscard]] Item output_item(const std::string& id,
                               const PrintedAxis& printed,
                               const TumbledAxes& axes,
                               const TumbleRecord& record,
                               double gravity_mps2);

/// Table 5.1.
[[nodiscard]] Item bias_scale_item(const TumbledAxes& axes,
                                   const TumbleRecord& record,
                                   double gravity_mps2);

}  // namespace proofmass::thesis
