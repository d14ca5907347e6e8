#include <array>
#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/fit/curve.hpp"
#include "proofmass/signal/whiteness.hpp"

// Reference that shows why fit_drift does not use ordinary least squares with a test of the
// residuals' autocorrelation: 2 h at 1 Hz, in mg.
namespace proofmass::characterise::plain_fit_slow_test {
namespace {

using test::Series;

constexpr std::size_t samples = 7200;
constexpr double rate_hz = 1.0;
constexpr std::array<double, 3> truth{5.0, 900.0, 1.5};  // a1, T, a2
constexpr unsigned runs = 100;

double warm_up(double t_s, View<double> p) {
  return p[2] - p[0] * std::expm1(-t_s / p[1]);
}

struct PlainFits {
  /// Root mean square of (value − truth)/std for a1, T and a2: 1 if the std is correct.
  std::array<double, 3> understated_by{};
  /// Fraction of the fits whose residuals pass Ljung and Box's test of 20 lags at 5 %.
  double passed = 0.0;
};

double ljung_box_p(View<double> residuals) {
  constexpr std::size_t lags = 20, fitted = 3;
  const std::vector<double> r = signal::autocorrelation(residuals, lags);
  const auto n = static_cast<double>(residuals.size());
  double sum = 0.0;
  for (std::size_t k = 1; k <= lags; ++k) sum += r[k] * r[k] / (n - static_cast<double>(k));
  return chi_square_p(n * (n + 2.0) * sum, static_cast<double>(lags - fitted));
}

template <class Noise>
PlainFits fits_beside(const Noise& noise) {
  PlainFits found;
  Series time_s;
  for (std::size_t k = 0; k < samples; ++k) time_s.push_back(static_cast<double>(k) / rate_hz);
  for (unsigned run = 0; run < runs; ++run) {
    Series y = noise(100 + 3 * run);
    for (std::size_t k = 0; k < samples; ++k) y[k] += warm_up(time_s[k], truth);
    const auto fit = fit::fit_curve(time_s, y, warm_up, truth).value();
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double error = (fit.parameters[j] - truth[j]) / fit.std[j];
      found.understated_by[j] += error * error / runs;
    }
    for (std::size_t k = 0; k < samples; ++k) y[k] -= warm_up(time_s[k], fit.parameters);
    found.passed += ljung_box_p(y) > 0.05 ? 1.0 / runs : 0.0;
  }
  for (double& ratio : found.understated_by) ratio = std::sqrt(ratio);
  for (std::size_t j = 0; j < truth.size(); ++j)
    testing::Test::RecordProperty("understated_" + std::to_string(j),
                                  std::to_string(found.understated_by[j]));
  testing::Test::RecordProperty("passed", std::to_string(found.passed));
  return found;
}

Series white(unsigned seed) {
  return test::white(1.0, rate_hz, samples, seed);
}

TEST(PlainFit, IsRightAboutItsErrorsInWhiteNoise) {
  const PlainFits found = fits_beside(white);
  for (const double ratio : found.understated_by) EXPECT_NEAR(ratio, 1.0, 0.2);
  EXPECT_GT(found.passed, 0.85);
}

TEST(PlainFit, UnderstatesItsErrorsByTimesInARandomWalkThatTheCommonTestPasses) {
  const PlainFits found = fits_beside([](unsigned seed) {
    return test::sum_of({white(seed), test::random_walk(0.005, rate_hz, samples, seed + 1)});
  });
  EXPECT_GT(found.understated_by[0], 3.0);
  EXPECT_GT(found.understated_by[1], 4.0);
  EXPECT_GT(found.understated_by[2], 2.0);
  EXPECT_GT(found.passed, 0.3);
}

TEST(PlainFit, UnderstatesItsErrorsByTimesInMarkovNoise) {
  const PlainFits found = fits_beside([](unsigned seed) {
    const double q = 0.3 * std::sqrt(2.0 / 60.0);
    const Series slow = test::markov(q, 60.0, rate_hz, samples, seed + 1);
    return test::sum_of({white(seed), slow});
  });
  for (const double ratio : found.understated_by) EXPECT_GT(ratio, 2.0);
  EXPECT_LT(found.passed, 0.05);
}

}  // namespace
}  // namespace proofmass::characterise::plain_fit_slow_test
