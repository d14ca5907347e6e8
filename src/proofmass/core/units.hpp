#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace proofmass {

/// Physical quantity of a channel.
enum class Quantity {
  unknown,
  counts,  ///< raw instrument counts, scale not stated
  time,
  acceleration,
  angular_rate,
  angle,
  voltage,
  temperature,
  length,
  speed,
  pressure,
  magnetic_field,
};

/// A unit as written, and its conversion to SI: si = value · to_si + offset.
struct Unit {
  Quantity quantity = Quantity::unknown;
  double to_si = 1.0;
  double offset_si = 0.0;  ///< nonzero for degrees Celsius only
  std::string symbol;      ///< Proofmass's spelling: "m/s^2"; empty if unknown

  [[nodiscard]] double si(double value) const { return value * to_si + offset_si; }
  friend bool operator==(const Unit&, const Unit&) = default;
};

/// Standard acceleration of gravity, exact: the size of the unit g. Local gravity is different:
/// sensor/gravity.hpp. Source: 3rd CGPM (1901), resolution 2.
inline constexpr double standard_gravity_mps2 = 9.80665;

inline constexpr double rad_per_deg = std::numbers::pi / 180.0, deg_per_rad = 1.0 / rad_per_deg;
inline constexpr double rad_per_turn = 2.0 * std::numbers::pi;
inline constexpr double radps_per_rpm = rad_per_turn / 60.0;

/// Parses a unit as headers write it: "m/s^2", "m/s²", "mps2", "[g]", "(mG)", "µs", "deg/s", "LSB".
/// Surrounding brackets and blanks are ignored; case matters only where it changes the meaning (mG
/// can be a magnetic field unit, so only "mg" is milli-g; "G" is a gauss). nullopt if unknown.
[[nodiscard]] std::optional<Unit> parse_unit(std::string_view text);

/// "acceleration", "angular rate", …
[[nodiscard]] std::string_view name_of(Quantity quantity);

}  // namespace proofmass
