#include "proofmass/calibrate/rotating/words.hpp"

#include <algorithm>
#include <array>
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
      fit.doubts.push_back(
          fmt::format("axis {}: {:.0f} % of the output's variation does not follow the rotation of "
                      "gravity: a test needs a "
                      "wheel on a bench, whose axle is stationary",
                      axis + 1, 100.0 * left));
    }
    const auto& k1 = fit.axes[axis][RotationQuantity::K1].value;
    if (options.readings_are_accelerations && k1 && std::abs(k1->value - 1.0) > off) {
      fit.doubts.push_back(
          fmt::format("axis {}: K1 = {} for data in units of acceleration, where about 1 is "
                      "expected: the unit or gravity is wrong, the axle is not horizontal, or the "
                      "axis is not in the plane of the wheel",
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

const char* how_often(int per_turn) {
  constexpr std::array words{"once", "twice", "three times", "four times", "five times"};
  return words[static_cast<std::size_t>(per_turn - 1)];
}

// "1.1 % once and 0.3 % three times"
std::string accepted_ripples(const RotationFit& fit) {
  std::string text;
  for (const SpeedRipple& ripple : fit.ripples) {
    if (!ripple.accepted || !ripple.amplitude) continue;
    text += fmt::format("{}{:.2g} % {}", text.empty() ? "" : ", ", 100.0 * ripple.amplitude->value,
                        how_often(ripple.per_turn));
  }
  return text;
}

void note_accepted(const RotationFit& fit, std::vector<std::string>& notes) {
  const std::string found = accepted_ripples(fit);
  if (found.empty()) return;
  notes.push_back(
      fmt::format("{} a speed that varies within the turn, by {} a turn; it was taken "
                  "out",
                  fit.axes.size() == 2 ? "both axes show" : "the harmonics show", found));
  if (fit.radius.value) return;
  notes.push_back(fmt::format(
      "it varies r ω² and r ω̇ too: for the radius, which one speed does not determine, a standard "
      "deviation of {} m was allowed",
      assumed_radius_std_m));
}

void note_shared(const RotationFit& fit, std::vector<std::string>& notes) {
  constexpr double beyond_chance = 0.01;
  for (const SpeedRipple& ripple : fit.ripples) {
    if (ripple.per_turn > 2 || ripple.accepted || ripple.chance_p >= beyond_chance) continue;
    notes.push_back(fmt::format(
        "the {} harmonics are beyond chance (p = {:.2g}): without an encoder they may be the "
        "sensor's or those of a speed that varies {} a turn, and the intervals hold both",
        ripple.per_turn == 1 ? "second" : "third", ripple.chance_p, how_often(ripple.per_turn)));
  }
}

}  // namespace

void note_zero(const RotationState& state, RotationFit& fit) {
  if (state.zero == EncoderZero::wheel)
    fit.notes.push_back(
        "the zero of the encoder's angle is not that of the sensor's axes: the angle is measured "
        "from gravity in the first axis, which leaves that axis's misalignment undetermined");
  if (state.zero == EncoderZero::none)
    fit.notes.push_back(
        "the encoder counts from another zero in each recording: the angle is measured from "
        "gravity in the first axis, which leaves that axis's misalignment and the sensor's delay "
        "undetermined");
}

void note_ripples(const RotationOptions& options, RotationFit& fit) {
  const double g = options.gravity_mps2, one = 0.01;
  // A phase error ε sin nφ, ε = one/n, moves the harmonics n ± 1 by ε/2: n = 1 both B0 and C2 of
  // K0 = (B0 + C2)/K1, n = 2 both S1 and S3 of K1 = (S1 + 3 S3)/g.
  fit.per_percent = {.bias_mps2 = one * g,
                     .second_order_s2pm = one / g,
                     .scale_relative = one,
                     .misalignment_rad = 0.25 * one,
                     .third_order_s4pm2 = one / (g * g)};
  if (fit.angle_given) {
    fit.notes.push_back(fmt::format(
        "an angle that is wrong as if the speed varied by 1 % once a turn would look like K2 − Kpp "
        "or Kip of {:.2g} g/g² and a bias of {:.2g} mg; twice a turn, like {:.2g} % of K1, a "
        "misalignment of {:.2g} mrad and K3 of {:.2g} g/g³",
        fit.per_percent.second_order_s2pm * g, 1e3 * fit.per_percent.bias_mps2 / g,
        100.0 * fit.per_percent.scale_relative, 1e3 * fit.per_percent.misalignment_rad,
        fit.per_percent.third_order_s4pm2 * g * g));
    return;
  }
  note_accepted(fit, fit.notes);
  note_shared(fit, fit.notes);
  if (fit.axes.size() == 1)
    fit.notes.push_back(
        "one axis without an encoder does not determine the sense of rotation: the sign of Kip is "
        "valid if the output's rise precedes its maximum");
}

}  // namespace proofmass::calibrate
