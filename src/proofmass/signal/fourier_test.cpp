#include "proofmass/signal/fourier.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace proofmass::signal::fourier_test {
namespace {

std::vector<double> random_series(std::size_t n) {
  std::mt19937_64 engine(n);
  std::vector<double> series(n);
  for (double& x : series) x = static_cast<double>(engine() >> 11) * 0x1p-52 - 1.0;
  return series;
}

double by_definition(const std::vector<double>& x, std::size_t k) {
  const auto n = static_cast<double>(x.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += x[i] * std::cos(std::numbers::pi * static_cast<double>(k * (2 * i + 1)) / (2.0 * n));
  return sum * std::sqrt((k == 0 ? 1.0 : 2.0) / n);
}

TEST(CosineTransform, IsItsDefinitionAtEveryLength) {
  for (const std::size_t n : {1u, 2u, 3u, 4u, 5u, 8u, 12u, 31u, 37u, 74u, 101u, 360u, 411u}) {
    const std::vector<double> x = random_series(n), X = cosine_transform(x);
    ASSERT_EQ(X.size(), n);
    for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(X[k], by_definition(x, k), 1e-12) << n;
  }
}

TEST(CosineTransform, KeepsTheSumOfSquares) {
  for (const std::size_t n : {65'536u, 90'000u, 10'007u, 20'014u}) {
    const std::vector<double> x = random_series(n), X = cosine_transform(x);
    double before = 0.0, after = 0.0;
    for (const double v : x) before += v * v;
    for (const double v : X) after += v * v;
    EXPECT_NEAR(after / before, 1.0, 1e-12) << n;
  }
}

TEST(CosineTransform, PutsAConstantIntoItsFirstCoefficient) {
  const std::vector<double> X = cosine_transform(std::vector<double>(50, 3.0));
  EXPECT_NEAR(X[0], 3.0 * std::sqrt(50.0), 1e-13);
  for (std::size_t k = 1; k < X.size(); ++k) EXPECT_NEAR(X[k], 0.0, 1e-13);
}

TEST(CosineTransform, OfNothingIsNothing) {
  EXPECT_TRUE(cosine_transform({}).empty());
  EXPECT_TRUE(cosine_sums({}).empty());
}

TEST(CosineSums, AreTheirDefinitionAtEveryLength) {
  for (const std::size_t n : {1u, 2u, 3u, 8u, 37u, 74u, 360u, 411u}) {
    const std::vector<double> w = random_series(n), sums = cosine_sums(w);
    ASSERT_EQ(sums.size(), n + 1);
    for (std::size_t d = 0; d <= n; ++d) {
      double wanted = 0.0;
      for (std::size_t k = 0; k < n; ++k)
        wanted +=
            w[k] * std::cos(std::numbers::pi * static_cast<double>(k * d) / static_cast<double>(n));
      EXPECT_NEAR(sums[d], wanted, 1e-12 * static_cast<double>(n)) << n << ", " << d;
    }
  }
}

}  // namespace
}  // namespace proofmass::signal::fourier_test
