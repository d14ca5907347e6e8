#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace proofmass::sensor {

/// Unit of a sensor's figure as written, and its conversion to SI: si = value · to_si + offset_si.
struct FigureUnit {
  std::string symbol = "1";     ///< as written: "ug/sqrt(Hz)"
  std::string si_symbol = "1";  ///< its SI equivalent: "m/s^2/sqrt(Hz)"
  double to_si = 1.0;
  double offset_si = 0.0;  ///< nonzero for degrees Celsius only
  friend bool operator==(const FigureUnit&, const FigureUnit&) = default;
};

/// Parses all units of core's parse_unit and, in addition: "1", "%", "ppm", "Hz", "kHz"; an
/// acceleration per "sqrt(Hz)", "rtHz" or "√Hz", per "sqrt(s)" and per a time; "m/s^3",
/// "m/s^3/sqrt(Hz)" (which is m/s^2/sqrt(s)); volts or counts per acceleration, "V/g" or
/// "mV/(m/s^2)". For gyroscopes an angular rate, "deg/h", "deg/sqrt(h)", "deg/h/sqrt(h)", an
/// angular rate per "sqrt(Hz)", per "sqrt(s)" and per acceleration ("deg/s/g"), volts or counts per
/// angular rate ("mV/(deg/s)"). nullopt if unknown.
[[nodiscard]] std::optional<FigureUnit> parse_figure_unit(std::string_view text);

/// One figure of a sensor, as its author wrote it.
struct Figure {
  double value = 0.0;
  std::optional<double> std;  ///< one standard deviation, in the same unit, if known
  FigureUnit unit;
  std::string origin;  ///< its source: "ADXL335 datasheet rev. B, table 1"

  [[nodiscard]] double si() const { return value * unit.to_si + unit.offset_si; }
  [[nodiscard]] std::optional<double> std_si() const {
    return std ? std::optional(*std * unit.to_si) : std::nullopt;
  }
  friend bool operator==(const Figure&, const Figure&) = default;
};

/// A figure in a unit known to parse_figure_unit (a precondition).
[[nodiscard]] Figure make_figure(double value, std::string_view unit, std::string_view origin);

/// One figure for each of the axes x, y, z, if known.
using AxisFigures = std::array<std::optional<Figure>, 3>;

/// Three values with one unit and origin.
[[nodiscard]] AxisFigures make_axis_figures(const std::array<double, 3>& values,
                                            std::string_view unit,
                                            std::string_view origin);

}  // namespace proofmass::sensor
