#include "proofmass/estimate/tune/outliers.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"

namespace proofmass::estimate::tune_outliers_test {
namespace {

// White noise of a standard deviation of 1 on a random walk.
std::vector<double> walk(std::size_t samples, double step_std) {
  Random random(7, "tune outliers");
  std::vector<double> values;
  double level = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    values.push_back(level + random.normal());
    level += step_std * random.normal();
  }
  return values;
}

Tuning tuned(const std::vector<double>& values,
             const TuneOptions& options = {.model = TuneModel::rest}) {
  return tune({{.name = "x", .rate_hz = 1.0, .segments = {values}}}, options).value();
}

double value_of(const Tuning& tuning, const std::string& name) {
  for (const TunedParameter& parameter : tuning.parameters)
    if (parameter.name == name && parameter.value) return parameter.value->value;
  ADD_FAILURE() << name;
  return 0.0;
}

TEST(TuneOutliers, LeaveTheEstimatesOfTheOtherMeasurements) {
  for (const double step_std : {0.0, 0.05, 3.0}) {
    std::vector<double> values = walk(4000, step_std), without = values;
    const double size = 20.0 * std::hypot(1.0, step_std);
    // Single, in a pair of one sign, and in one of two.
    for (const auto& [k, sign] : {std::pair{100, 1.0},
                                  {900, -3.0},
                                  {901, -3.5},
                                  {2000, 30.0},
                                  {2500, 2.0},
                                  {2501, -2.5},
                                  {3999, 4.0}}) {
      values[static_cast<std::size_t>(k)] += sign * size;
      without[static_cast<std::size_t>(k)] = std::numeric_limits<double>::quiet_NaN();
    }
    const Tuning found = tuned(values), clean = tuned(without);
    EXPECT_EQ(found.series.front().outliers.count, 7U) << step_std;
    EXPECT_NEAR(found.series.front().outliers.largest, 30.0 * size, 0.3 * size);
    EXPECT_EQ(found.series.front().missing, 0U);
    EXPECT_EQ(found.series.front().readings, 3993U);
    EXPECT_NEAR(value_of(found, "white"), value_of(clean, "white"), 1e-6);
    if (step_std > 0.0) {
      EXPECT_NEAR(value_of(found, "random_walk"), value_of(clean, "random_walk"), 1e-6);
    }
  }
}

TEST(TuneOutliers, AreNeitherStepsNorMotion) {
  for (const double step_std : {0.0, 0.05, 3.0}) {
    std::vector<double> values = walk(4000, step_std);
    for (std::size_t k = 2000; k < values.size(); ++k) values[k] += 60.0 * (1.0 + step_std);
    EXPECT_EQ(tuned(values).series.front().outliers.count, 0U) << step_std;
  }
  std::vector<double> jolted = walk(4000, 0.0);
  for (std::size_t k = 200; k < jolted.size(); k += 200) jolted[k] += 40.0;
  EXPECT_EQ(tuned(jolted, {.model = TuneModel::pva}).series.front().outliers.count, 0U);
}

// Once in a few hundred samples the noise exceeds half a step of the converter.
TEST(TuneOutliers, AreNotTheStepsOfACoarseConverter) {
  std::vector<double> values = walk(20'000, 0.0);
  for (double& x : values) x = std::round(0.17 * x);
  const Tuning found = tuned(values);
  EXPECT_EQ(found.series.front().outliers.count, 0U);
  EXPECT_GT(value_of(found, "white"), 0.03);
}

TEST(TuneOutliers, AreNotFoundWithNoiseThatIsGivenOrShared) {
  const std::vector<double> values = walk(4000, 0.1);
  EXPECT_EQ(tuned(values, {.fixed = {{"white", 0.25}}}).series.front().outliers.count, 0U);
  std::vector<double> larger = walk(3000, 0.1);
  for (double& x : larger) x *= 30.0;
  const Tuning shared = tune({{"x", 1.0, {walk(30'000, 0.1)}}, {"y", 1.0, {larger}}},
                             {.shared = {"white", "random_walk"}})
                            .value();
  EXPECT_EQ(shared.series[1].outliers.count, 0U);
}

}  // namespace
}  // namespace proofmass::estimate::tune_outliers_test
