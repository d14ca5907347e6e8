#include "proofmass/calibrate/rotating/results.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using Q = RotationQuantity;

constexpr std::string_view one_speed =
    "radius and radial bias are not separable at one speed: record a second speed";

// A quantity's value and its derivatives by the harmonics of its axis.
struct Derived {
  double value = 0.0;
  Harmonics gradient = Harmonics::Zero();
};

// numerator/denominator, both linear in the harmonics.
Derived ratio(const Harmonics& h, const Harmonics& above, const Harmonics& below) {
  const double a = above.dot(h), b = below.dot(h);
  return {a / b, above / b - a / (b * b) * below};
}

Harmonics unit(std::initializer_list<std::pair<Index, double>> parts) {
  Harmonics vector = Harmonics::Zero();
  for (const auto& [at, factor] : parts) vector(at) = factor;
  return vector;
}

struct Speeds {
  double gravity_mps2, mean_square;
};

Derived derived(Q quantity, const Harmonics& h, const Speeds& at) {
  const double g = at.gravity_mps2;
  const Harmonics k1 = unit({{1, 1.0 / g}, {5, 3.0 / g}});
  switch (quantity) {
    case Q::K1:
      return {k1.dot(h), k1};
    case Q::K0:
      return ratio(h, unit({{0, 1.0}, {4, 1.0}, {7, 1.0}}), k1);
    case Q::K0_radial:
      return ratio(h, unit({{0, 1.0}, {4, 1.0}}), k1);
    case Q::misalignment:
      return ratio(h, unit({{2, 1.0 / g}}), k1);
    case Q::K2_minus_Kpp:
      return ratio(h, unit({{4, -2.0 / (g * g)}}), k1);
    case Q::Kip:
      return ratio(h, unit({{3, 2.0 / (g * g)}}), k1);
    case Q::K3:
      return ratio(h, unit({{5, -4.0 / (g * g * g)}}), k1);
    case Q::radius:
      return ratio(h, unit({{7, 1.0 / at.mean_square}}), k1);
  }
  return {};
}

// How the value follows gravity: value · power · u(g)/g.
double power_of_gravity(Q quantity) {
  switch (quantity) {
    case Q::K1:
    case Q::K2_minus_Kpp:
    case Q::Kip:
      return -1.0;
    case Q::K3:
      return -2.0;
    case Q::K0:
    case Q::K0_radial:
    case Q::radius:
      return 1.0;
    case Q::misalignment:
      return 0.0;
  }
  return 0.0;
}

std::string why_not(const RotationState& state,
                    const RotationFit& fit,
                    std::size_t axis,
                    Q quantity) {
  const auto accepted = [&](int per_turn) {
    return std::ranges::any_of(fit.ripples, [&](const SpeedRipple& one) {
      return one.per_turn == per_turn && one.accepted;
    });
  };
  switch (quantity) {
    case Q::K0:
    case Q::radius:
      return state.speed_determined ? "" : std::string(one_speed);
    case Q::misalignment:
      if (axis > 0) return "";
      if (!state.angle_given) return "without an encoder the misalignment is part of the phase";
      return state.zero == EncoderZero::sensor
                 ? ""
                 : "the zero of the encoder's angle is not that of the sensor's axes";
    case Q::K2_minus_Kpp:
    case Q::Kip:
      return accepted(1)
                 ? "the second harmonics of both axes are those of a speed that varies once "
                   "a turn, from which the sensor's part cannot be separated without an "
                   "encoder"
                 : "";
    case Q::K3:
      return accepted(2) ? "the third harmonics of both axes are those of a speed that varies "
                           "twice a turn, from which the sensor's part cannot be separated without "
                           "an encoder"
                         : "";
    default:
      return "";
  }
}

constexpr double normal_factor = 1.959964;  // 95 % of a normal distribution

double half_width(double std, double dof) {
  return std * student_t_quantile(0.975, dof);
}

// Covariance of two slow figures: variances with their bounds, the correlation of the blocks.
Eigen::Matrix2d slow_covariance(const Eigen::MatrixXd& J, const RotationEstimate& estimate) {
  const Eigen::Matrix2d blocks = estimate.covariance_of(J * estimate.blocks.scores);
  Eigen::Vector2d factor;
  for (Index k = 0; k < 2; ++k) {
    const RotationSpread spread = estimate.spread_of(J.row(k).transpose(), true);
    const double scatter = half_width(spread.std, spread.dof);
    const double std = estimate.half_width(J.row(k).transpose(), scatter) / normal_factor;
    factor(k) = blocks(k, k) > 0.0 ? std / std::sqrt(blocks(k, k)) : 0.0;
  }
  return factor.asDiagonal() * blocks * factor.asDiagonal();
}

void fill_radius(const RotationState& state,
                 const RotationEstimate& estimate,
                 const RotationOptions& options,
                 RotationFit& fit) {
  RotationCoefficient& radius = fit.radius;
  if (!state.speed_determined) {
    radius.reason = one_speed;
    return;
  }
  if (state.axes == 1) {
    radius = fit.axes[0][Q::radius];
    return;
  }
  const Index size = state.size();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, size);
  Eigen::Vector2d along;
  for (Index axis = 0; axis < 2; ++axis) {
    const Derived one =
        derived(Q::radius, estimate.harmonics.segment<harmonic_count>(harmonic_count * axis),
                {options.gravity_mps2, state.mean_square_speed});
    along(axis) = one.value;
    J.row(axis).segment<harmonic_count>(harmonic_count * axis) = one.gradient.transpose();
  }
  // Where the second axis is not square to the first it lies along that in part.
  const double off_square =
      (estimate.harmonics(harmonic_count + 2) / estimate.harmonics(harmonic_count + 1)) -
      estimate.harmonics(2) / estimate.harmonics(1);
  along(1) += off_square * along(0);
  J.row(1) += off_square * J.row(0);
  const Eigen::Matrix2d C = slow_covariance(J, estimate);
  const auto length = cross_axis_sensitivity(along, C, 0.0);
  if (!length) {
    radius.reason = length.error().message;
  } else if (!length->value) {
    radius.reason =
        fmt::format("the radius is not distinguishable from zero: it is below {:.3g} m (95 %)",
                    length->upper_95);
  } else {
    radius.value = length->value;
    radius.half_width_95 = normal_factor * length->value->std;
  }
}

struct OfAxis {
  std::size_t axis;
  RotationCoefficient& coefficient;
};

// Value, standard deviation and interval; whether these had to be widened.
bool fill_value(const RotationState& state,
                const RotationEstimate& estimate,
                const RotationOptions& options,
                const OfAxis& of) {
  RotationCoefficient& one = of.coefficient;
  const Index from = harmonic_count * static_cast<Index>(of.axis);
  const Derived found = derived(one.quantity, estimate.harmonics.segment<harmonic_count>(from),
                                {options.gravity_mps2, state.mean_square_speed});
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(state.size());
  gradient.segment<harmonic_count>(from) = found.gradient;
  const bool slow =
      one.quantity == Q::K0 || one.quantity == Q::K0_radial || one.quantity == Q::radius;
  const RotationSpread spread = estimate.spread_of(gradient, slow);
  const double by_gravity = found.value * power_of_gravity(one.quantity) *
                            options.gravity_std_mps2 / options.gravity_mps2;
  one.half_width_95 = estimate.half_width(
      gradient, std::hypot(half_width(spread.std, spread.dof), normal_factor * by_gravity));
  one.value = Uncertain{found.value, one.half_width_95 / normal_factor};
  return spread.widened;
}

}  // namespace

std::string_view name_of(RotationQuantity quantity) {
  constexpr std::array<std::string_view, rotation_quantities> names{
      "K1", "K0", "K0_radial", "misalignment_rad", "K2_minus_Kpp", "Kip", "K3", "radius_m"};
  return names[static_cast<std::size_t>(quantity)];
}

void fill_rotation(const RotationState& state,
                   const RotationEstimate& estimate,
                   const RotationOptions& options,
                   RotationFit& fit) {
  std::string widened_names;
  fit.axes.resize(state.axes);
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const auto h =
        estimate.harmonics.segment<harmonic_count>(harmonic_count * static_cast<Index>(axis));
    std::copy_n(h.begin(), fit.axes[axis].harmonics.size(), fit.axes[axis].harmonics.begin());
    for (std::size_t q = 0; q < rotation_quantities; ++q) {
      RotationCoefficient& one = fit.axes[axis].coefficients[q];
      one.quantity = static_cast<Q>(q);
      one.reason = why_not(state, fit, axis, one.quantity);
      if (!one.reason.empty() || !fill_value(state, estimate, options, {axis, one})) continue;
      widened_names += (widened_names.empty() ? "" : ", ") + std::string(name_of(one.quantity));
      if (state.axes > 1) widened_names += fmt::format(" of axis {}", axis + 1);
    }
  }
  fill_radius(state, estimate, options, fit);
  if (widened_names.empty()) return;
  fit.notes.push_back(
      fmt::format("adjacent blocks of {:.0f} turns are correlated in {}: the output drifts; "
                  "standard deviations were increased accordingly",
                  estimate.blocks.turns_per_block, widened_names));
}

}  // namespace proofmass::calibrate
