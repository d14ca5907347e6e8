#include "proofmass/calibrate/rotating/harmonics.hpp"

#include <cmath>

namespace proofmass::calibrate {

Harmonics columns_at(const ColumnPoint& point) {
  const double s = std::sin(point.phase), c = std::cos(point.phase);
  Harmonics columns;
  columns(0) = 1.0;
  double s_n = s, c_n = c;
  for (int n = 1; n <= highest_harmonic; ++n) {
    columns(sine_column(n)) = s_n;
    columns(sine_column(n) + 1) = c_n;
    const double next = s_n * c + c_n * s;
    c_n = c_n * c - s_n * s;
    s_n = next;
  }
  columns(square_speed_column) = 1.0 - point.relative_square_speed;
  columns(delay_column) = c * point.relative_speed;
  return columns;
}

double slope_at(const Harmonics& x, const Harmonics& h) {
  double slope = 0.0;
  for (int n = 1; n <= highest_harmonic; ++n) {
    const Eigen::Index k = sine_column(n);
    slope += n * (h(k) * x(k + 1) - h(k + 1) * x(k));
  }
  return slope;
}

RippleAt ripple_at(const Ripple& ripple, double phase) {
  RippleAt at;
  for (int n = 1; n <= highest_ripple; ++n) {
    const double a = ripple(2 * n - 2), b = ripple(2 * n - 1);
    const double c = std::cos(n * phase), s = std::sin(n * phase);
    at.value += a * c + b * s;
    at.slope += n * (b * c - a * s);
    at.curvature -= n * n * (a * c + b * s);
  }
  return at;
}

}  // namespace proofmass::calibrate
