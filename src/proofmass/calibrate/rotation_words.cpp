#include "proofmass/calibrate/rotation_words.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "proofmass/core/number_words.hpp"

namespace proofmass::calibrate {

double relative_residual(const RotationState& state, std::size_t axis) {
  return std::sqrt(2.0 * state.variance[axis]) /
         std::hypot(state.harmonics[axis](1), state.harmonics[axis](2));
}

void note_doubts(const RotationState& state, const RotationOptions& options, RotationFit& fit) {
  constexpr double much = 0.15, half = 0.5, off = 0.3;
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    const double left = relative_residual(state, axis);
    if (left > much) {
      fit.doubts.push_back(fmt::format(
          "axis {}: {:.0f} % of the readings' swing does not follow gravity's turn: a test wants a "
          "wheel on a bench, whose axle stands still",
          axis + 1, 100.0 * left));
    }
    const auto& k1 = fit.axes[axis][RotationQuantity::K1].value;
    if (options.readings_are_accelerations && k1 && std::abs(k1->value - 1.0) > off) {
      fit.doubts.push_back(
          fmt::format("axis {}: K1 = {} of readings that are accelerations, where about 1 is "
                      "expected: the unit or gravity is wrong, the axle is not horizontal, or the "
                      "axis does not lie in the plane of the wheel",
                      axis + 1, compact(k1->value, 3)));
    }
  }
  if (fit.steady_fraction < half) {
    fit.doubts.push_back(fmt::format("only {:.0f} % of the recorded time is steady turning",
                                     100.0 * fit.steady_fraction));
  }
  if (!fit.converged) fit.doubts.push_back("the fit did not settle");
}

namespace {

void note_ripple(const SpeedRipple& ripple, double gravity, RotationFit& fit) {
  const bool once = ripple.per_turn == 1;
  constexpr double beyond_chance = 0.01;
  if (ripple.accepted && ripple.amplitude) {
    fit.notes.push_back(
        fmt::format("both axes show a speed that varies by {:.2g} % {} a turn; it was taken out",
                    100.0 * ripple.amplitude->value, once ? "once" : "twice"));
  } else if (!ripple.accepted && ripple.chance_p < beyond_chance) {
    fit.notes.push_back(fmt::format(
        "the {} harmonics of the axes are not those of a varying speed alone (p = {:.2g}): they "
        "are put down to the sensor",
        once ? "second" : "third", ripple.ripple_p));
  }
  if (!once || !ripple.accepted || !ripple.amplitude || fit.radius.value) return;
  // r ω² swings by 2 r ω² times the ripple.
  double square = 0.0;
  for (const RotationSection& one : fit.sections) {
    square = std::max(square, one.speed_radps * one.speed_radps);
  }
  constexpr double example_m = 0.1;
  fit.notes.push_back(fmt::format(
      "it swings r ω² too: each {} m of radius, which is not told, makes up to {:.2g} % "
      "of K1",
      example_m, 100.0 * 2.0 * ripple.amplitude->value * example_m * square / gravity));
}

}  // namespace

void note_ripples(const RotationOptions& options, RotationFit& fit) {
  const double g = options.gravity_mps2, one = 0.01;
  // A phase error ε sin nφ, ε = one/n, has harmonics n ± 1 of ε/2.
  fit.per_percent = {.bias_mps2 = 0.5 * one * g,
                     .second_order_s2pm = one / g,
                     .scale_relative = 0.25 * one,
                     .misalignment_rad = 0.25 * one,
                     .third_order_s4pm2 = one / (g * g)};
  bool once = false, twice = false;
  for (const SpeedRipple& ripple : fit.ripples) {
    (ripple.per_turn == 1 ? once : twice) = ripple.accepted;
    note_ripple(ripple, g, fit);
  }
  const std::string what =
      fit.angle_given ? "an angle that is wrong as if the speed varied" : "a speed that varies";
  if (!once) {
    fit.notes.push_back(fmt::format(
        "{} by 1 % once a turn would look like K2 − Kpp or Kip of {:.2g} g/g² and a bias of "
        "{:.2g} mg",
        what, fit.per_percent.second_order_s2pm * g, 1e3 * fit.per_percent.bias_mps2 / g));
  }
  if (!twice) {
    fit.notes.push_back(fmt::format(
        "{} by 1 % twice a turn would look like {:.2g} % of K1, a misalignment of {:.2g} mrad and "
        "K3 of {:.2g} g/g³",
        what, 100.0 * fit.per_percent.scale_relative, 1e3 * fit.per_percent.misalignment_rad,
        fit.per_percent.third_order_s4pm2 * g * g));
  }
  if (fit.axes.size() == 1 && !fit.angle_given) {
    fit.notes.push_back(
        "one axis without an encoder does not show which way the wheel turns: the sign of Kip is "
        "that of a wheel on which the reading's rise is followed by its top");
  }
}

}  // namespace proofmass::calibrate
