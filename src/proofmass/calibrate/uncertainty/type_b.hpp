#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/calibrate/uncertainty_budget.hpp"
#include "proofmass/core/result.hpp"

// Uncertainty contributions that the data do not show and the user must state (type B evaluation).
namespace proofmass::calibrate {

/// Target of a contribution.
enum class TypeBTarget {
  bias,
  scale,
  misalignment,
  k0,     ///< bias of the IEEE 1293 model equation
  k1,     ///< its scale factor
  angle,  ///< of the positions
  gravity,
};

/// "bias", "scale", "misalignment", "K0", "K1", "angle", "gravity".
[[nodiscard]] std::string_view name_of(TypeBTarget target);

struct TypeB {
  std::string source;  ///< "ADC reference"
  TypeBTarget target = TypeBTarget::bias;
  std::optional<std::size_t> axis;  ///< 0, 1, 2; absent: every axis
  /// One error common to all axes (a shared reference), instead of an independent one for each.
  bool common = false;
  Distribution distribution = Distribution::normal;
  double std = 0.0;  ///< SI
  /// "m/s^2", "V" or "counts" for a bias; "1" (relative), "V/(m/s^2)" or "counts/(m/s^2)" for a
  /// scale; "rad" for an angle.
  std::string unit;
  double dof = 0.0;  ///< 0: infinite
};

/// Parses NAME,TARGET,VALUE UNIT[,DISTRIBUTION[,DOF]]:
///
///     ADC reference,scale,0.05 %,uniform
///     drift,bias.z,0.3 mg
///     temperature,bias,2 K * 1 mg/K,uniform
///     alignment,misalignment,0.1 deg,triangular
///
/// - NAME is free; "ADC reference", "gravity" and "supply" are one error common to all axes.
/// - TARGET is one of name_of(TypeBTarget), followed by .x, .y or .z for one axis.
/// - VALUE is the standard deviation of a normal (the default) or student-t distribution, which
///   needs DOF, and the half width of a uniform, triangular or arcsine one.
/// - Blanks around commas and the case of words do not matter.
///
/// Errors: invalid_argument, one line that states what was expected.
[[nodiscard]] Result<TypeB> parse_type_b(std::string_view text);

/// The parameter to which a line contributes.
struct ParameterUnit {
  std::string_view reading;  ///< "m/s^2", "V" or "counts"
  double scale = 1.0;        ///< output's unit per m/s^2
};

/// The line in the budget of its target, with the sensitivity that converts its unit to the
/// parameter's: a bias is in the output's unit, K0 in m/s^2, a scale or K1 in the output's unit per
/// m/s^2, an angle in rad, gravity in m/s^2. Errors: invalid_argument (incompatible unit; scale is
/// 0).
[[nodiscard]] Result<BudgetLine> line_of(const TypeB& type_b, const ParameterUnit& parameter);

}  // namespace proofmass::calibrate
