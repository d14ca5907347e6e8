// The tumble test of IEEE 1293 through the library: positions of a turntable in, coefficients of
// the model equation out, each with its definition, its standard deviation and the origin of that.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/core/units.hpp"

namespace cal = proofmass::calibrate;

namespace {

constexpr double g = proofmass::standard_gravity_mps2;

/// An ADXL335 at 3.3 V on the table: 33.7 mV per m/s² about 1.65 V, its input axis misaligned by 2
/// mrad.
double reading_v(double angle_rad) {
  const double ai = g * std::sin(angle_rad), ap = g * std::cos(angle_rad);
  return 1.65 + 0.0337 * (0.12 + ai + 2e-3 * ap + 2e-5 * ai * ai + 3e-6 * ai * ai * ai);
}

}  // namespace

int main() {
  // Every 30°, with the first position repeated at the end, which shows the drift.
  std::mt19937_64 bits(1);
  std::normal_distribution<double> noise(0.0, 20e-6);
  std::vector<cal::TumblePosition> positions;
  for (int k = 0; k <= 12; ++k) {
    const double angle_rad = 2.0 * std::numbers::pi * (k % 12) / 12.0;
    positions.push_back({.angle_rad = angle_rad, .output = reading_v(angle_rad) + noise(bits)});
  }
  const auto fit = cal::fit_tumble(
      positions,
      {.gravity_mps2 = g, .gravity_std_mps2 = 5e-5, .indexing_std_rad = 5e-6, .output_unit = "V"});
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return 1;
  }
  for (const cal::TumbleCoefficient& c : fit->coefficients) {
    if (!c.value) continue;
    std::printf("%-18s %13.6g +- %8.2g %-10s %s\n", std::string(name_of(c.quantity)).c_str(),
                *c.value, c.std.value_or(0.0), c.unit.c_str(), c.meaning.c_str());
  }
  std::printf("%s\n", fit->drift.words.c_str());
  for (const std::string& words : fit->indexing.words) std::printf("%s\n", words.c_str());

  // Apply bias and scale factor to a measurement: at 30° the table gives half of gravity.
  const auto* K1 = fit->find(cal::TumbleQuantity::K1);
  const double force_mps2 = (reading_v(std::numbers::pi / 6.0) - *fit->bias_output) / *K1->value;
  std::printf("at 30 degrees: %.4f m/s^2, g/2 is %.4f\n", force_mps2, 0.5 * g);
  return std::abs(*K1->value - 0.0337) < 4.0 * *K1->std && std::abs(force_mps2 - 0.5 * g) < 0.03
             ? 0
             : 1;
}
