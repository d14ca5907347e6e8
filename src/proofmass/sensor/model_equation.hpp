#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

// The full model equation of a linear accelerometer.
namespace proofmass::sensor {

/// The coefficients of E(a, ω), E the output in its own unit [V, counts, m/s^2 …]. SI: no g.
/// Source: IEEE Std 1293-2018, annex on the model equation, as written in the thesis of M. A. Lele
/// (2010), section 2.3.
// NOLINTBEGIN(readability-identifier-naming): these are the standard's names.
struct ModelEquation {
  double K1 = 1.0;       ///< scale factor [unit of E per m/s^2]
  double K0 = 0.0;       ///< bias [m/s^2]
  double K0_asym = 0.0;  ///< K0', bias asymmetry [m/s^2]
  double K1_asym = 0.0;  ///< K1', scale-factor asymmetry [1]
  double Koq = 0.0;      ///< odd quadratic [1/(m/s^2)]
  double K2 = 0.0;       ///< second order [1/(m/s^2)]
  double K3 = 0.0;       ///< third order [1/(m/s^2)^2]
  double delta_o = 0.0;  ///< misalignment about the output axis [rad]
  double delta_p = 0.0;  ///< misalignment about the pendulous axis [rad]
  double Kip = 0.0;      ///< cross-coupling of input and pendulous axis [1/(m/s^2)]
  double Kio = 0.0;      ///< cross-coupling of input and output axis [1/(m/s^2)]
  double Kpo = 0.0;      ///< cross-coupling of pendulous and output axis [1/(m/s^2)]
  double Kpp = 0.0;      ///< cross-axis nonlinearity, pendulous axis [1/(m/s^2)]
  double Koo = 0.0;      ///< cross-axis nonlinearity, output axis [1/(m/s^2)]
  double Kspin = 0.0;    ///< spin correction [m/s^2 per (rad/s)^2]
  double Kang = 0.0;     ///< angular acceleration about the output axis [m/s^2 per rad/s^2]
  friend bool operator==(const ModelEquation&, const ModelEquation&) = default;
};
// NOLINTEND(readability-identifier-naming)

/// Input of the model equation: specific force along the input, pendulous and output axes (i, p,
/// o), angular rates about the first two, angular acceleration about the third.
struct Motion {
  double ai_mps2 = 0.0, ap_mps2 = 0.0, ao_mps2 = 0.0;
  double omega_i_radps = 0.0, omega_p_radps = 0.0;
  double omega_dot_o_radps2 = 0.0;
};

/// The output,
///
///     E = K1 (K0 + (K0'/2) sgn a_i + (1 + (K1'/2) sgn a_i) a_i
///             + K_oq a_i |a_i| + K2 a_i² + K3 a_i³ + δ_o a_p − δ_p a_o
///             + K_ip a_i a_p + K_io a_i a_o + K_po a_p a_o + K_pp a_p² + K_oo a_o²
///             + K_spin ω_i ω_p + K_ang ω̇_o),   sgn 0 = 0.
[[nodiscard]] double output(const ModelEquation& equation, const Motion& motion);

/// The coefficients by name, in the order of the equation.
// NOLINTBEGIN(readability-identifier-naming)
enum class Coefficient : std::size_t {
  K1,
  K0,
  K0_asym,
  K1_asym,
  Koq,
  K2,
  K3,
  delta_o,
  delta_p,
  Kip,
  Kio,
  Kpo,
  Kpp,
  Koo,
  Kspin,
  Kang
};
// NOLINTEND(readability-identifier-naming)
inline constexpr std::size_t coefficient_count = 16;

/// One coefficient: the single definition of its name, units and meaning.
struct CoefficientInfo {
  Coefficient coefficient;
  std::string_view name;           ///< as in JSON and on the command line: "K2"
  std::string_view symbol;         ///< typeset form: "K₂"
  std::string_view unit;           ///< in SI; "{}" is replaced by the unit of the output in K1's
  std::string_view standard_unit;  ///< unit in the standard: "g/g²"
  int power_of_g;                  ///< value in the standard's unit = value in SI · g^power
  std::string_view description;    ///< short description
  double ModelEquation::* member;
};

/// All sixteen, indexed by Coefficient.
[[nodiscard]] std::span<const CoefficientInfo, coefficient_count> coefficients();

[[nodiscard]] const CoefficientInfo& info(Coefficient coefficient);

/// Lookup by name, ignoring case; also "K0'" and "K1'". Absent if unknown.
[[nodiscard]] std::optional<Coefficient> coefficient_named(std::string_view name);

/// A coefficient's value in the standard's unit, with g = 9.80665 m/s².
[[nodiscard]] double in_standard_unit(Coefficient coefficient, double value);

/// The factor of the coefficient inside the bracket: ∂(E/K1)/∂coefficient; a_i for K1.
[[nodiscard]] double term(Coefficient coefficient, const Motion& motion);

}  // namespace proofmass::sensor
