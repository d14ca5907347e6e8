// Coverage of the 95 % intervals.
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/tune.hpp"

namespace proofmass::estimate::tune_slow_test {
namespace {

struct Truth {
  std::size_t samples;
  double step_variance;  // of measurements with variance 1
  int runs;
};

// Coverage of each parameter over the runs, R first.
std::array<double, 2> coverage(const Truth& truth) {
  std::array<double, 2> inside{};
  for (int run = 0; run < truth.runs; ++run) {
    Random random(static_cast<std::uint64_t>(run), "coverage of tune");
    std::vector<double> values;
    double level = 0.0;
    for (std::size_t k = 0; k < truth.samples; ++k) {
      values.push_back(level + random.normal());
      level += std::sqrt(truth.step_variance) * random.normal();
    }
    const Tuning found = tune({{"x", 1.0, {values}}}, {.model = TuneModel::local_level}).value();
    for (std::size_t j = 0; j < 2; ++j) {
      const double true_value = j == 0 ? 1.0 : truth.step_variance;
      const TunedParameter& parameter = found.parameters[j];
      const bool above = true_value >= parameter.lower_95.value_or(0.0);
      const bool below = !parameter.upper_95 || true_value <= *parameter.upper_95;
      if (above && below) inside[j] += 1.0 / truth.runs;
    }
  }
  return inside;
}

TEST(TuneCoverage, IntervalsHoldTheTruthInNinetyFiveOfAHundredRuns) {
  for (const Truth& truth : {Truth{300, 0.05, 1500}, Truth{1000, 0.01, 800}}) {
    for (const double share : coverage(truth)) {
      EXPECT_GT(share, 0.93) << truth.samples;
      EXPECT_LT(share, 0.97) << truth.samples;
    }
  }
}

TEST(TuneCoverage, ALimitOfANoiseThatIsNotThereIsSeldomBroken) {
  const auto share = coverage({.samples = 300, .step_variance = 0.0, .runs = 800});
  EXPECT_GT(share[0], 0.93);
  EXPECT_LT(share[0], 0.97);
  EXPECT_GT(share[1], 0.95);  // in 1.7 % of the runs zero is reported as a value
}

}  // namespace
}  // namespace proofmass::estimate::tune_slow_test
