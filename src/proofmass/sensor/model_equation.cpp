#include "proofmass/sensor/model_equation.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/units.hpp"

namespace proofmass::sensor {
namespace {

using C = Coefficient;
using M = ModelEquation;

constexpr std::string_view per_accel = "1/(m/s^2)", g_per_g2 = "g/g²";

constexpr std::array<CoefficientInfo, coefficient_count> table{{
    {C::K1, "K1", "K₁", "{}/(m/s^2)", "{}/g", 1, "scale factor", &M::K1},
    {C::K0, "K0", "K₀", "m/s^2", "g", -1, "bias", &M::K0},
    {C::K0_asym, "K0_asym", "K₀′", "m/s^2", "g", -1, "bias asymmetry", &M::K0_asym},
    {C::K1_asym, "K1_asym", "K₁′", "1", "1", 0, "scale factor asymmetry", &M::K1_asym},
    {C::Koq, "Koq", "K_oq", per_accel, g_per_g2, 1, "odd quadratic coefficient", &M::Koq},
    {C::K2, "K2", "K₂", per_accel, g_per_g2, 1, "second-order coefficient", &M::K2},
    {C::K3, "K3", "K₃", "1/(m/s^2)^2", "g/g³", 2, "third-order coefficient", &M::K3},
    {C::delta_o, "delta_o", "δ_o", "rad", "rad", 0, "misalignment about the output axis",
     &M::delta_o},
    {C::delta_p, "delta_p", "δ_p", "rad", "rad", 0, "misalignment about the pendulous axis",
     &M::delta_p},
    {C::Kip, "Kip", "K_ip", per_accel, g_per_g2, 1, "cross-coupling of input and pendulous axis",
     &M::Kip},
    {C::Kio, "Kio", "K_io", per_accel, g_per_g2, 1, "cross-coupling of input and output axis",
     &M::Kio},
    {C::Kpo, "Kpo", "K_po", per_accel, g_per_g2, 1, "cross-coupling of pendulous and output axis",
     &M::Kpo},
    {C::Kpp, "Kpp", "K_pp", per_accel, g_per_g2, 1, "cross-axis nonlinearity, pendulous axis",
     &M::Kpp},
    {C::Koo, "Koo", "K_oo", per_accel, g_per_g2, 1, "cross-axis nonlinearity, output axis",
     &M::Koo},
    {C::Kspin, "Kspin", "K_spin", "(m/s^2)/(rad/s)^2", "g/(rad/s)²", -1, "spin correction",
     &M::Kspin},
    {C::Kang, "Kang", "K_ang", "(m/s^2)/(rad/s^2)", "g/(rad/s²)", -1,
     "angular acceleration about the output axis", &M::Kang},
}};

double sgn(double x) {
  return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool alike(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

double term(Coefficient coefficient, const Motion& motion) {
  const double i = motion.ai_mps2, p = motion.ap_mps2, o = motion.ao_mps2;
  switch (coefficient) {
    case C::K1:
      return i;
    case C::K0:
      return 1.0;
    case C::K0_asym:
      return 0.5 * sgn(i);
    case C::K1_asym:
      return 0.5 * std::abs(i);
    case C::Koq:
      return i * std::abs(i);
    case C::K2:
      return i * i;
    case C::K3:
      return i * i * i;
    case C::delta_o:
      return p;
    case C::delta_p:
      return -o;
    case C::Kip:
      return i * p;
    case C::Kio:
      return i * o;
    case C::Kpo:
      return p * o;
    case C::Kpp:
      return p * p;
    case C::Koo:
      return o * o;
    case C::Kspin:
      return motion.omega_i_radps * motion.omega_p_radps;
    case C::Kang:
      return motion.omega_dot_o_radps2;
  }
  return 0.0;
}

double output(const ModelEquation& equation, const Motion& motion) {
  double bracket = motion.ai_mps2;
  for (const CoefficientInfo& one : table) {
    if (one.coefficient == C::K1) continue;
    bracket += equation.*one.member * term(one.coefficient, motion);
  }
  return equation.K1 * bracket;
}

std::span<const CoefficientInfo, coefficient_count> coefficients() {
  return table;
}

const CoefficientInfo& info(Coefficient coefficient) {
  return table[static_cast<std::size_t>(coefficient)];
}

std::optional<Coefficient> coefficient_named(std::string_view name) {
  if (alike(name, "K0'")) return C::K0_asym;
  if (alike(name, "K1'")) return C::K1_asym;
  for (const CoefficientInfo& one : table) {
    if (alike(name, one.name)) return one.coefficient;
  }
  return std::nullopt;
}

double in_standard_unit(Coefficient coefficient, double value) {
  return value * std::pow(standard_gravity_mps2, info(coefficient).power_of_g);
}

}  // namespace proofmass::sensor
