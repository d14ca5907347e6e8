#include "proofmass/calibrate/uncertainty/type_b_effect.hpp"

#include <fmt/format.h>

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

// Index of the first of the target's three parameters; −1 if it has none here.
Index first_of(TypeBTarget target) {
  switch (target) {
    case TypeBTarget::bias:
      return 0;
    case TypeBTarget::scale:
    case TypeBTarget::gravity:
      return 3;
    case TypeBTarget::misalignment:
      return 6;
    case TypeBTarget::k0:
    case TypeBTarget::k1:
    case TypeBTarget::angle:
      break;
  }
  return -1;
}

bool estimated(const MultiPosition& fit, Index k) {
  const auto axis = static_cast<std::size_t>(k % 3);
  if (k < 3) return fit.bias[axis].has_value();
  return k < 6 ? fit.scale[axis].has_value() : fit.misalignment_rad[axis].has_value();
}

Result<TypeBEffect> effect_of(const MultiPosition& fit,
                              const TypeB& type_b,
                              std::string_view reading_unit) {
  const Index first = first_of(type_b.target);
  if (first < 0)
    return Error{Errc::invalid_argument,
                 fmt::format("{}: {} is a contribution to a tumble test: to a calibration in "
                             "several positions belong bias, scale, misalignment and gravity",
                             type_b.source, name_of(type_b.target))};
  TypeBEffect effect;
  effect.common = type_b.common;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Index k = first + static_cast<Index>(axis);
    if ((type_b.axis && *type_b.axis != axis) || !estimated(fit, k)) continue;
    const double scale = fit.estimate[3 + axis];
    const Result<BudgetLine> line = line_of(type_b, {reading_unit, scale});
    if (!line) return line.error();
    effect.line = *line;
    const bool by_gravity = type_b.target == TypeBTarget::gravity;
    effect.sensitivity(k) = by_gravity ? -scale / fit.gravity_mps2 : line->sensitivity;
  }
  return effect;
}

}  // namespace

Eigen::Matrix<double, 9, 9> TypeBEffect::covariance() const {
  const Eigen::Matrix<double, 9, 1> c = line.std * sensitivity;
  if (common) return c * c.transpose();
  return c.cwiseAbs2().asDiagonal();
}

Result<std::vector<TypeBEffect>> effects_of(const MultiPosition& fit,
                                            View<TypeB> lines,
                                            std::string_view reading_unit) {
  std::vector<TypeBEffect> effects;
  for (const TypeB& type_b : lines) {
    const Result<TypeBEffect> effect = effect_of(fit, type_b, reading_unit);
    if (!effect) return effect.error();
    if (effect->sensitivity.any()) effects.push_back(*effect);
  }
  return effects;
}

}  // namespace proofmass::calibrate
