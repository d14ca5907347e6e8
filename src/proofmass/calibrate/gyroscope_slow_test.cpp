#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/calibrate/gyroscope_budget.hpp"
#include "proofmass/calibrate/gyroscope_test_support.hpp"

// Coverage of the 95 % intervals over simulated recordings.
namespace proofmass::calibrate::gyroscope_slow_test {
namespace {

struct Coverage {
  std::array<int, 5> inside{}, count{};  // bias, scale, misalignment, alignment, g-sensitivity

  void add(const GyroscopeCalibration& fit, const test::GyroscopeTruth& truth) {
    const std::vector<UncertaintyBudget> budgets = budget_of(fit, "rad/s");
    ASSERT_EQ(budgets.size(), gyroscope_parameters);
    for (std::size_t k = 0; k < gyroscope_parameters; ++k) {
      const double error = budgets[k].measurand.value - truth.p(static_cast<Eigen::Index>(k));
      const std::size_t group = std::min<std::size_t>(k / 3, 4);
      ++count[group];
      inside[group] += std::abs(error) < budgets[k].expanded_95 ? 1 : 0;
    }
  }
};

constexpr std::array<const char*, 5> groups{"bias", "scale", "misalignment", "alignment",
                                            "g-sensitivity"};

// 93 to 97 %, cautious up to 99 %, of at least 100 recordings.
void expect_coverage(const Coverage& coverage, const std::string& what) {
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const double percent = 100.0 * coverage.inside[k] / coverage.count[k];
    EXPECT_GE(percent, 93.0) << what << ", " << groups[k];
    EXPECT_LE(percent, 99.0) << what << ", " << groups[k];
  }
}

Eigen::Vector3d drawn_earth(std::mt19937_64& random, double& latitude_rad) {
  latitude_rad = std::asin(std::uniform_real_distribution<double>(-1.0, 1.0)(random));
  const double heading =
      std::uniform_real_distribution<double>(0.0, 2.0 * std::numbers::pi)(random);
  return 7.292115e-5 * Eigen::Vector3d(std::cos(latitude_rad) * std::cos(heading),
                                       std::cos(latitude_rad) * std::sin(heading),
                                       std::sin(latitude_rad));
}

TEST(GyroscopeCoverage, OfAHandTurnedSensorOfThePhoneKindIsThatStated) {
  std::mt19937_64 random(20260101);
  Coverage coverage;
  for (int run = 0; run < 200; ++run) {
    test::GyroscopeTruth truth = test::drawn_gyroscope(random);
    double latitude_rad = 0.0;
    truth.earth_radps = drawn_earth(random, latitude_rad);
    test::SimulatedRecording recording = test::simulate(truth, {}, random);
    const MultiPosition accelerometer = test::accelerometer_of(recording.session);
    const auto fit =
        calibrate_gyroscope({&recording.session, 1}, accelerometer, {.latitude_rad = latitude_rad});
    ASSERT_TRUE(fit) << fit.error().message;
    coverage.add(*fit, truth);
  }
  expect_coverage(coverage, "white noise");
}

// A drift of 0.02 °/s over 100 s adds to the scatter of the means at rest.
TEST(GyroscopeCoverage, HoldsWithABiasThatDrifts) {
  std::mt19937_64 random(20260102);
  Coverage coverage;
  for (int run = 0; run < 150; ++run) {
    test::GyroscopeTruth truth = test::drawn_gyroscope(random);
    truth.walk = 3.5e-5;
    test::SimulatedRecording recording = test::simulate(truth, {.rests = 24}, random);
    const MultiPosition accelerometer = test::accelerometer_of(recording.session);
    const auto fit =
        calibrate_gyroscope({&recording.session, 1}, accelerometer, {.latitude_rad = 0.0});
    ASSERT_TRUE(fit) << fit.error().message;
    // The bias is that of the session.
    truth.p.head<3>() += recording.mean_drift;
    coverage.add(*fit, truth);
  }
  expect_coverage(coverage, "drift");
}

}  // namespace
}  // namespace proofmass::calibrate::gyroscope_slow_test
