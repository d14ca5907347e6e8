#include "proofmass/calibrate/tumble/components.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/calibrate/tumble.hpp"

namespace proofmass::calibrate::tumble_components_test {
namespace {

// Six positions of a box on its faces, with table angles that do not apply: residuals of 1 g where
// the noise of a mean is 2e-4 g.
TEST(FitTumble, EndsWhereTheAnglesContradictTheOutputs) {
  const double quarter = 0.5 * std::numbers::pi;
  const double angles[] = {0.0, quarter, 2.0 * quarter, 3.0 * quarter, 0.0, 0.0};
  const double times_s[] = {5.72, 19.46, 30.645, 41.995, 54.66, 67.07};
  const double outputs[3][6] = {{9.761171, -10.107758, -0.177798, -0.249463, -0.198308, -0.143796},
                                {0.182518, 0.206867, 9.908930, -9.511281, 0.342971, 0.145566},
                                {0.064086, -0.020989, 0.000123, -0.014041, 9.808835, -9.796257}};
  for (const auto& axis : outputs) {
    std::vector<TumblePosition> positions;
    for (std::size_t k = 0; k < 6; ++k)
      positions.push_back({.angle_rad = angles[k],
                           .output = axis[k],
                           .output_std = 6e-4,
                           .time_s = times_s[k],
                           .label = {}});
    const auto fit = fit_tumble(positions, {.gravity_mps2 = 9.80665, .noise_dof = 5000.0});
    if (!fit) continue;
    for (const TumbleCoefficient& one : fit->coefficients)
      EXPECT_TRUE(!one.std || std::isfinite(*one.std));
  }
}

}  // namespace
}  // namespace proofmass::calibrate::tumble_components_test
