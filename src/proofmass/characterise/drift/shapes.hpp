#pragma once

#include <array>
#include <cstddef>

#include "proofmass/characterise/drift_model.hpp"

// Non-exponential warm-ups, and the slow oscillation that resembles one.
namespace proofmass::characterise {

/// Shapes that compete with the exponential for a drift, τ their scale:
///
///     square root            √t                     heat into a half-space
///     logarithm              ln(1 + t/τ)            relaxation with many time constants
///     hyperbola              t/(t + τ)
///     stretched exponential  1 − e^(−√(t/τ))        exponent ½
///     sine                   sin 2πt/τ, cos 2πt/τ   temperature of a room, τ the period
///
/// Source: H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), section 2.9,
/// the square root; J. C. Phillips, Rep. Prog. Phys. 59 (1996) 1133, the stretched exponential and
/// the others as its neighbours.
inline constexpr std::array rival_shapes{DriftShape::square_root, DriftShape::logarithm,
                                         DriftShape::hyperbola, DriftShape::stretched_exponential,
                                         DriftShape::sine};

[[nodiscard]] bool is_rival(DriftShape shape);

[[nodiscard]] bool is_exponential(DriftShape shape);

/// Number of columns of a shape, without line and steps, that depend on its scales.
[[nodiscard]] std::size_t amplitudes_of(DriftShape shape);

/// Number of its scales: time constants, or the τ of a rival.
[[nodiscard]] std::size_t scales_of(DriftShape shape);

/// A column of a rival at t, 0 before t = 0 except for the sine; and its derivative by ln τ.
struct RivalColumn {
  DriftShape shape = DriftShape::logarithm;
  std::size_t column = 0;
  double scale_s = 1.0;
  [[nodiscard]] double at(double t_s) const;
  [[nodiscard]] double by_log_scale(double t_s) const;
};

}  // namespace proofmass::characterise
