#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/calibrate/tumble/axes.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/thesis/angular_bias.hpp"

// The axes of a four-point tumble, each fitted, for the thesis's figures.
namespace proofmass::thesis {

/// Output of an ideal sensor: zero + scale · force. In volts it is the thesis's ADXL335 at 3.3 V,
/// 1.65 V and 0.33 V/g.
struct IdealOutput {
  double zero = 0.0, scale = 1.0;  ///< SI unit of the output, that unit per m/s²
};

/// Absent for counts and unknown units.
[[nodiscard]] std::optional<IdealOutput> ideal_output(const Unit& unit);

/// Uncertainty of gravity: as given, for the standard value, or computed from the location.
[[nodiscard]] double gravity_std_mps2(const TumbleRecord& record, double gravity_mps2);

/// One channel that responds to the table's rotation.
struct TumbledAxis {
  std::string name;
  std::string unit;                  ///< of the outputs, SI
  std::optional<IdealOutput> ideal;  ///< then `positions` hold the force that it would read
  calibrate::TumbleAxis axis;
  std::vector<calibrate::TumblePosition> positions;
  double noise_dof = 0.0;  ///< of their noise; 0: infinite
  calibrate::TumbleFit fit;

  /// Angle of the input axis above the horizontal.
  [[nodiscard]] double phi_rad(const calibrate::TumblePosition& position) const;
  /// A measurement in the output's own unit, and its noise.
  [[nodiscard]] double output(double reading) const;
  [[nodiscard]] double output_size(double reading) const;
  /// Mean of the positions of the first plane at this angle of the table, within half a degree; std
  /// 0 if their noise is unknown; absent if there are none.
  [[nodiscard]] std::optional<Uncertain> mean_at(double angle_rad) const;
  /// A coefficient's value; 0 where the positions do not determine it.
  [[nodiscard]] double value_of(calibrate::TumbleQuantity quantity) const;
};

/// Analysis of the channels. x is the first that follows ± sin of the table's angle, y the first
/// that follows ± cos.
struct TumbledAxes {
  std::optional<TumbledAxis> x, y;
  std::vector<std::string> refused;  ///< sentences: channels that do not respond
};

/// Errors: those of fit_tumble(), with the channel's name.
[[nodiscard]] Result<TumbledAxes> analyse_tumble(const TumbleRecord& record, double gravity_mps2);

}  // namespace proofmass::thesis
