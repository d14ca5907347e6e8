#pragma once

namespace proofmass::io::tdms {

/// Voltage in millivolts of a thermocouple of type B, E, J, K, N, R, S or T at a temperature in
/// degrees Celsius, reference junction at 0 °C; NaN outside the range of the type.
/// Source: Burns, Scroger, Strouse, Croarkin and Guthrie, "Temperature-Electromotive Force
/// Reference Functions and Tables for the Letter-Designated Thermocouple Types Based on the
/// ITS-90", NIST Monograph 175 (1993).
[[nodiscard]] double thermocouple_mv(char type, double temp_degc);

/// The reverse, by the approximate inverses given there, within 0.06 °C of the reference function.
/// NaN outside their range: B from 250 °C, E, J, K, N and T from −200 °C (J −210 °C).
[[nodiscard]] double thermocouple_degc(char type, double voltage_mv);

}  // namespace proofmass::io::tdms
