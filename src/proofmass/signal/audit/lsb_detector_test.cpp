#include "proofmass/signal/audit/lsb_detector.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace proofmass::signal {
namespace {

std::vector<double> noise(std::size_t count, double step, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> values(count);
  for (double& value : values) value = normal(random);
  if (step > 0.0)
    for (double& value : values) value = step * std::round(value / step);
  return values;
}

double quantum_of(View<double> values, std::size_t soon) {
  LsbDetector detector(soon);
  for (std::size_t k = 0; k < values.size(); ++k) detector.add(k, values[k]);
  return detector.quantum();
}

TEST(LsbDetector, FindsTheStepOfAConverter) {
  std::mt19937_64 random(1);
  EXPECT_EQ(quantum_of(noise(5000, 0.125, random), 50), 0.125);
  EXPECT_EQ(quantum_of(noise(5000, 0.0, random), 50), 0.0);
}

TEST(LsbDetector, FindsTheSameStepInGroupsOfSamples) {
  std::mt19937_64 random(2);
  for (const double step : {0.0, 1e-7, 1e-3, 0.01, 0.25, 2.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      // Continuous values with a short segment of a converter, so that the fast path is taken too.
      std::vector<double> values = noise(3000, 0.0, random);
      const std::vector<double> coarse = noise(100, step, random);
      const std::size_t at = random() % 2900;
      std::copy(coarse.begin(), coarse.end(), values.begin() + static_cast<std::ptrdiff_t>(at));
      LsbDetector detector(20);
      for (std::size_t from = 0, count = 0; from < values.size(); from += count) {
        count = std::min<std::size_t>(1 + random() % 600, values.size() - from);
        detector.add(from, View<double>(values).subspan(from, count));
        EXPECT_EQ(detector.quantum(), quantum_of(View<double>(values).first(from + count), 20))
            << step << ", sample " << from;
      }
    }
  }
}

}  // namespace
}  // namespace proofmass::signal
