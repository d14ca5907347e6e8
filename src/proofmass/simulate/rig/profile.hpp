#pragma once

#include <cmath>
#include <numbers>

// Motion profiles as functions of the fraction s in [0, 1].
namespace proofmass::simulate {

/// A motion from 0 to 1, its velocity and its acceleration.
struct Way {
  double place, velocity, accel;
};

/// The smoothest profile. Source: T. Flash, N. Hogan, Journal of Neuroscience 5 (1985) 1688.
[[nodiscard]] inline Way minimum_jerk(double s) {
  return {s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * s * s * (1.0 - s) * (1.0 - s),
          60.0 * s * (1.0 - 3.0 * s + 2.0 * s * s)};
}

/// 0 with zero slope at both ends, 1 in the middle.
[[nodiscard]] inline double swell(double s) {
  const double sine = std::sin(std::numbers::pi * s);
  return sine * sine;
}

}  // namespace proofmass::simulate
