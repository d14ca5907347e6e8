#include "proofmass/fit/curve.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace proofmass::fit::curve_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double line(double x, View<double> p) {
  return p[0] + p[1] * x;
}

struct Points {
  std::vector<double> x, y;
};

Points scattered_line() {
  std::mt19937_64 bits(3);
  std::normal_distribution<double> normal;
  Points points;
  for (int k = 0; k < 25; ++k) {
    points.x.push_back(0.1 * k);
    points.y.push_back(2.0 - 0.5 * points.x.back() + 0.1 * normal(bits));
  }
  return points;
}

TEST(FitCurve, TheBandOfALineIsTheTextbooks) {
  const auto [x, y] = scattered_line();
  const LeastSquaresFit fit = fit_curve(x, y, line, std::vector{0.0, 0.0}).value();
  const double n = 25.0, mean = 1.2;
  double sxx = 0.0;
  for (const double at : x) sxx += (at - mean) * (at - mean);
  const std::vector<double> where = {-1.0, 1.2, 5.0};
  const std::vector<CurvePoint> band = curve_with_band(where, line, fit);
  ASSERT_EQ(band.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = 1.0 / n + (where[k] - mean) * (where[k] - mean) / sxx;
    EXPECT_NEAR(band[k].value, line(where[k], fit.parameters), 1e-14);
    EXPECT_NEAR(band[k].std, fit.residual_std * std::sqrt(share), 1e-10);
    EXPECT_NEAR(band[k].reading_std, fit.residual_std * std::sqrt(1.0 + share), 1e-10);
  }
}

TEST(FitCurve, AllSigmasTimesTenChangeNothingUnlessTheyAreKnown) {
  const auto [x, y] = scattered_line();
  CurveOptions options{.sigma = std::vector<double>(25, 0.1)};
  const std::vector start{0.0, 0.0};
  const auto one = fit_curve(x, y, line, start, options).value();
  options.sigma.assign(25, 1.0);
  const auto ten = fit_curve(x, y, line, start, options).value();
  EXPECT_TRUE(one.covariance.isApprox(ten.covariance, 1e-10));
  options.solver.unit_variance = true;
  const auto known = fit_curve(x, y, line, start, options).value();
  EXPECT_NEAR(known.std[0] * ten.residual_std / ten.std[0], 1.0, 1e-10);
  EXPECT_NEAR(known.parameters[0], one.parameters[0], 1e-10);
}

TEST(FitCurve, APointOfHalfTheSigmaCountsAsFour) {
  auto [x, y] = scattered_line();
  CurveOptions options{.sigma = std::vector<double>(25, 1.0)};
  options.sigma[7] = 0.5;
  const std::vector start{0.0, 0.0};
  const auto weighed = fit_curve(x, y, line, start, options).value();
  for (int k = 0; k < 3; ++k) {
    x.push_back(x[7]);
    y.push_back(y[7]);
  }
  const auto repeated = fit_curve(x, y, line, start).value();
  EXPECT_NEAR(weighed.parameters[0], repeated.parameters[0], 1e-11);
  EXPECT_NEAR(weighed.parameters[1], repeated.parameters[1], 1e-11);
}

TEST(FitCurve, TheBandIsAsWideAsTheScatterOfTheFits) {
  std::mt19937_64 bits(5);
  std::normal_distribution<double> normal;
  const CurveModel decay = [](double x, View<double> p) { return p[0] * std::exp(-x / p[1]); };
  const std::vector<double> truth{1.0, 2.0}, where{3.0};
  std::vector<double> x, y(60);
  for (int k = 0; k < 60; ++k) x.push_back(0.1 * k);
  double sum = 0.0, squares = 0.0, variances = 0.0;
  const int runs = 400;
  for (int run = 0; run < runs; ++run) {
    for (std::size_t k = 0; k < 60; ++k) y[k] = decay(x[k], truth) + 0.02 * normal(bits);
    const auto fit = fit_curve(x, y, decay, truth).value();
    const CurvePoint point = curve_with_band(where, decay, fit).front();
    sum += point.value;
    squares += point.value * point.value;
    variances += point.std * point.std;
  }
  const double variance = squares / runs - sum / runs * sum / runs;
  EXPECT_NEAR(std::sqrt(variances / runs / variance), 1.0, 0.11);
}

TEST(FitCurve, AParameterThatTheCurveDoesNotFeelLeavesItsBandFinite) {
  const auto [x, y] = scattered_line();
  const auto fit = fit_curve(x, y, line, std::vector{0.0, 0.0, 1.0}).value();
  EXPECT_TRUE(std::isinf(fit.std[2]));
  EXPECT_TRUE(std::isfinite(curve_with_band(x, line, fit)[0].std));
}

TEST(FitCurve, SaysWhyItCannot) {
  const std::vector<double> x{1.0, 2.0, 3.0}, start{0.0, 0.0};
  EXPECT_EQ(fit_curve(x, std::vector{1.0, 2.0}, line, start).error().code, Errc::invalid_argument);
  EXPECT_EQ(fit_curve(x, std::vector{1.0, nan, 2.0}, line, start).error().code, Errc::not_finite);
  EXPECT_EQ(fit_curve(x, x, line, start, {.sigma = {1.0, 0.0, 1.0}}).error().code,
            Errc::invalid_argument);
  EXPECT_EQ(fit_curve(x, x, line, start, {.sigma = {1.0}}).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::fit::curve_test
