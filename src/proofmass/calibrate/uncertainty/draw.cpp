#include "proofmass/calibrate/uncertainty/draw.hpp"

#include <cmath>
#include <numbers>

namespace proofmass::calibrate {

double Draw::operator()(Distribution distribution, double dof) {
  // Each kind uses two numbers, so that a change of one input leaves the others' draws unchanged.
  // Logarithms need (0, 1].
  const double u = 1.0 - random_.unit(), v = 1.0 - random_.unit();
  switch (distribution) {
    case Distribution::uniform:
      return std::numbers::sqrt3 * (2.0 * u - 1.0);
    case Distribution::triangular:
      return std::sqrt(6.0) * (u + v - 1.0);
    case Distribution::arcsine:
      return std::numbers::sqrt2 * std::cos(2.0 * std::numbers::pi * u);
    case Distribution::student_t:
      if (dof > 0.0)
        return std::sqrt(dof * std::expm1(-2.0 / dof * std::log(u))) *
               std::cos(2.0 * std::numbers::pi * v);
      break;
    case Distribution::normal:
      break;
  }
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

}  // namespace proofmass::calibrate
