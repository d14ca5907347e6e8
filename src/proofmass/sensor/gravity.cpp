#include "proofmass/sensor/gravity.hpp"

#include <cmath>

namespace proofmass::sensor {

double gravity_mps2(const Place& place) {
  constexpr double gamma_e = 9.7803253359;  // γ_e, m/s²
  constexpr double k = 0.00193185265241;    // b γ_p / (a γ_e) − 1
  constexpr double e2 = 0.00669437999014;   // first eccentricity, squared
  constexpr double a = 6378137.0;           // m
  constexpr double f = 1.0 / 298.257223563;
  constexpr double m = 0.00344978650684;  // ω² a² b / GM
  const double sin2 = std::pow(std::sin(place.latitude_rad), 2);
  const double on_ellipsoid = gamma_e * (1.0 + k * sin2) / std::sqrt(1.0 - e2 * sin2);
  const double h = place.height_m / a;
  return on_ellipsoid * (1.0 - 2.0 * (1.0 + f + m - 2.0 * f * sin2) * h + 3.0 * h * h);
}

}  // namespace proofmass::sensor
