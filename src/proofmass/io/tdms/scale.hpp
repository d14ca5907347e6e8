#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io::tdms {

/// y = slope · x + intercept
struct Linear {
  double slope = 1.0;
  double intercept = 0.0;
};

/// y = Σ c[i] · x^i
struct Polynomial {
  std::vector<double> coefficients;
};

/// Linear interpolation between points, constant beyond them.
struct Lookup {
  std::vector<double> x;  ///< ascending
  std::vector<double> y;
};

/// Voltage across a platinum thermometer to degrees Celsius. R(T) = R0 · (1 + A·T + B·T² + C·(T −
/// 100)·T³ below 0 °C). Source: IEC 60751 (2008), section 4.2.
struct Rtd {
  double current_amp = 0.0;
  double r0_ohm = 0.0;
  double a = 0.0, b = 0.0, c = 0.0;
  double lead_ohm = 0.0;  ///< subtracted: that of all leads in the measured path
};

/// Voltage across a bridge to strain. Source: National Instruments, "Connecting Strain Gages",
/// NI-DAQmx help: the equation of each configuration; Vr = (V − V0) / excitation.
struct Strain {
  enum class Bridge { full_1, full_2, full_3, half_1, half_2, quarter } bridge = Bridge::full_1;
  double poisson = 0.0;
  double gage_factor = 0.0;
  double excitation_volt = 0.0;
  double unstrained_volt = 0.0;
  double gain = 1.0;  ///< shunt calibration, and 1 + R_lead / R_gage except for full bridges
};

/// Voltage to kelvin minus an offset. 1/T = A + B·ln R + C·(ln R)³. Source: Steinhart and Hart,
/// "Calibration curves for thermistors", Deep-Sea Research 15 (1968).
struct Thermistor {
  bool is_divider = false;  ///< R = R1 / (excitation / V − 1); else R = V / excitation
  double excitation = 0.0;  ///< volts or amperes
  double r1_ohm = 0.0;
  double lead_ohm = 0.0;
  double a = 0.0, b = 0.0, c = 0.0;
  double offset_kelvin = 0.0;
};

/// Microvolts to degrees Celsius or the reverse, reference junction at 0 °C; NaN outside the type's
/// range.
struct Thermocouple {
  char type = 'J';
  bool to_voltage = false;
};

/// The right operand plus or minus the left one.
struct Sum {
  double sign_of_left = 1.0;
};

/// Identity scale.
struct Identity {};

using Scale =
    std::variant<Linear, Polynomial, Lookup, Rtd, Strain, Thermistor, Thermocouple, Sum, Identity>;

/// Reads NI_Scale[index]_* of a channel.
/// Errors: unsupported (an unknown kind; a missing or impossible property), a short message.
[[nodiscard]] Result<Scale> read_scale(const Properties& properties, std::uint32_t index);

/// "linear 2 x + 10", "thermocouple K": for a note.
[[nodiscard]] std::string words_for(const Scale& scale);

/// Precondition: equal lengths; `right` is used by Sum only.
void apply_scale(const Scale& scale, View<double> left, View<double> right, std::span<double> out);

}  // namespace proofmass::io::tdms
