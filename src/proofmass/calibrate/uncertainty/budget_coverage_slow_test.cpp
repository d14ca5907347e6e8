#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position_budget.hpp"
#include "proofmass/calibrate/uncertainty/budget_test_support.hpp"

namespace proofmass::calibrate::budget_coverage_slow_test {
namespace {

// Number of calibrations in which value ± U contains the truth, for each parameter. Gravity has a
// random error of 1e-3 m/s², the converter's reference one of 0.02 % in either direction.
std::array<double, 9> coverage(bool noise_known, int calibrations) {
  constexpr double gravity_std = 1e-3, reference = 2e-4;
  const std::vector<TypeB> lines{parse_type_b("ADC reference,scale,0.02 %,uniform").value()};
  const Parameters truth = analog_sensor();
  std::array<double, 9> inside{};
  Draw draw(11);
  for (int k = 0; k < calibrations; ++k) {
    const double local_g = g + gravity_std * draw.normal();
    std::vector<Pose> poses =
        poses_of(truth, noise_v, noise_known, 1000U + static_cast<std::uint64_t>(k), local_g);
    const double gain =
        1.0 + std_of_half_width(reference, Distribution::uniform) * draw(Distribution::uniform);
    Parameters seen = truth;
    seen.segment<3>(3) /= gain;
    for (Pose& pose : poses) pose.mean = seen.head<3>() + (pose.mean - truth.head<3>()) / gain;
    const auto fit =
        calibrate_positions(poses, with_gravity(gravity_std, noise_known ? 500.0 : 0.0)).value();
    const auto budgets = budget_of(fit, lines, "V").value();
    for (std::size_t j = 0; j < 9; ++j) {
      const double error = budgets[j].measurand.value - truth(static_cast<Eigen::Index>(j));
      inside[j] += std::abs(error) <= budgets[j].expanded_95 ? 1.0 / calibrations : 0.0;
    }
  }
  return inside;
}

TEST(ExpandedUncertainty, HoldsTheTruthInNinetyFivePercentOfCalibrations) {
  for (const bool noise_known : {true, false})
    for (const double share : coverage(noise_known, 1500)) {
      EXPECT_GT(share, 0.93) << noise_known;
      EXPECT_LT(share, 0.97) << noise_known;
    }
}

}  // namespace
}  // namespace proofmass::calibrate::budget_coverage_slow_test
