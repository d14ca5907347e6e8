#pragma once

#include <optional>
#include <string_view>

#include "proofmass/core/view.hpp"

// Accelerometers of several manufacturers by their datasheets, as data, for comparisons.
namespace proofmass::sensor {

/// How a datasheet states a figure: a typical value is met by most devices (one standard deviation,
/// where the maker says so), a limit by all.
enum class FigureKind { typical, limit };

struct PartFigure {
  double value = 0.0;
  FigureKind kind = FigureKind::typical;

  /// As a standard deviation: a typical value itself, of a limit that of a uniform distribution.
  /// Source: JCGM 100:2008, 4.3.7.
  [[nodiscard]] double std() const;
};

enum class PartOutput { analog, digital };

/// Figures at 25 °C in the smallest range, of the worst axis, in SI; absent where the datasheet has
/// none.
struct AccelerometerPart {
  std::string_view name, maker;
  PartOutput output = PartOutput::digital;
  std::string_view document;                          ///< the datasheet and its revision
  double range_mps2 = 0.0;                            ///< ±
  std::optional<PartFigure> noise_mps2_rthz = {};     ///< density, one-sided
  std::optional<PartFigure> offset_mps2 = {};         ///< ±, as delivered
  std::optional<PartFigure> offset_mps2_per_k = {};   ///< ±
  std::optional<PartFigure> in_run_mps2 = {};         ///< bias instability
  std::optional<PartFigure> repeatability_mps2 = {};  ///< ±, of the bias over the long term
  std::optional<PartFigure> scale = {};               ///< ± fraction, as delivered
  std::optional<PartFigure> scale_per_k = {};         ///< ± fraction
  std::optional<PartFigure> nonlinearity = {};        ///< ± fraction of full scale
  std::optional<PartFigure> cross_axis = {};          ///< ± fraction
};

/// Grouped by maker.
[[nodiscard]] View<AccelerometerPart> accelerometer_parts();

/// The part of this name, ignoring case and hyphens; nullptr if there is none.
[[nodiscard]] const AccelerometerPart* find_part(std::string_view name);

/// Gyroscopes of common inertial units.
struct GyroscopePart {
  std::string_view name, maker, document;
  double range_radps = 0.0;                           ///< ±, the largest
  std::optional<PartFigure> noise_radps_rthz = {};    ///< density, one-sided
  std::optional<PartFigure> offset_radps = {};        ///< ±, as delivered
  std::optional<PartFigure> offset_radps_per_k = {};  ///< ±
  std::optional<PartFigure> scale = {};               ///< ± fraction
  std::optional<PartFigure> nonlinearity = {};        ///< ± fraction of full scale
  std::optional<PartFigure> cross_axis = {};          ///< ± fraction
  std::optional<PartFigure> g_sensitivity_radps_per_mps2 = {};
};

[[nodiscard]] View<GyroscopePart> gyroscope_parts();

}  // namespace proofmass::sensor
