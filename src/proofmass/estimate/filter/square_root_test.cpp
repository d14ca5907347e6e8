#include "proofmass/estimate/filter/square_root.hpp"

#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <limits>
#include <optional>

#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/filter/reference_smoother_test_support.hpp"

namespace proofmass::estimate::square_root_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Three nearly constant states, measured by two nearly identical channels 1e9 times more precise
// than the prior: R/P₀ = 1e-18.
using Series = LinearSeries<3, 2>;
struct Case {
  std::vector<Epoch<2>> epochs;
  Series series;
  Gaussian<3> prior;
};
Case ill_conditioned(double reading_variance) {
  LinearModel<3, 2> m;
  m.F << 1.0, 0.1, 0.005, 0.0, 1.0, 0.1, 0.0, 0.0, 1.0;
  m.Q = 1e-20 * Mat<3, 3>::Identity();
  m.H << 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 + 1e-7;
  m.R.setConstant(reading_variance);
  std::vector<Epoch<2>> epochs(30);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    const double t = 0.1 * static_cast<double>(k);
    epochs[k] = {0.1, Mat<2>(1.0 + t, k % 4 == 2 ? none : 1.0 + t + 1e-8 * std::sin(7.0 * t))};
  }
  Gaussian<3> prior;
  prior.cov.setIdentity();
  auto series = Series::make(epochs, [&](double) { return m; }).value();
  return {epochs, std::move(series), prior};
}

/// Largest error of a mean in standard deviations, and of a covariance relative to √(Pii Pjj);
/// infinite if a variance is not positive.
struct Worst {
  double mean = 0.0, cov = 0.0;
  void add(const PackedGaussian<3>& x, const test::QuadBatch& exact, std::size_t epoch) {
    const auto at = [&](int i) { return 3 * epoch + static_cast<std::size_t>(i); };
    for (int i = 0; i < 3; ++i) {
      const double std = std::sqrt(static_cast<double>(exact.cov(at(i), at(i))));
      mean = std::max(mean, std::abs(x.mean(i) - static_cast<double>(exact.mean(at(i)))) / std);
      if (!(x.cov(i, i) > 0.0)) cov = std::numeric_limits<double>::infinity();
      for (int j = 0; j <= i; ++j) {
        const double scale = std * std::sqrt(static_cast<double>(exact.cov(at(j), at(j))));
        cov = std::max(
            cov, std::abs(x.cov(i, j) - static_cast<double>(exact.cov(at(i), at(j)))) / scale);
      }
    }
  }
};

TEST(SquareRoot, KeepsWhatTheCovarianceFormLosesWhereReadingsAreABillionTimesThePrior) {
  const Case c = ill_conditioned(1e-18);
  const std::vector<std::optional<double>> variance(3, 1.0);
  const auto exact = test::least_squares(c.series, c.epochs, variance, c.epochs.size());
  const auto first = test::least_squares(c.series, c.epochs, variance, 5);
  const auto root = smooth_square_root(c.series, c.prior).run;
  const auto plain = smooth_linear(c.series, c.prior);
  Worst filtered, smoothed, plain_smoothed;
  filtered.add(root.steps[4].filtered, first, 4);
  for (std::size_t k = 0; k < c.epochs.size(); ++k) {
    smoothed.add(root.steps[k].smoothed, exact, k);
    plain_smoothed.add(plain.steps[k].smoothed, exact, k);
  }
  EXPECT_LT(filtered.cov, 1e-12);
  EXPECT_LT(smoothed.cov, 1e-12);
  // Rounding of a measurement of magnitude 1 is a ten-millionth of its standard deviation.
  EXPECT_LT(smoothed.mean, 1e-4);
  EXPECT_EQ(plain_smoothed.cov, std::numeric_limits<double>::infinity());  // not positive definite
}

TEST(SquareRoot, ItsSquaresAreTheCovariances) {
  const Case c = ill_conditioned(1e-4);
  const auto root = smooth_square_root(c.series, c.prior);
  for (std::size_t k = 0; k < c.epochs.size(); ++k) {
    const Mat<3, 3>& L = root.smoothed_root[k];
    EXPECT_TRUE(L.isLowerTriangular(0.0));
    EXPECT_TRUE((L.diagonal().array() >= 0.0).all());
    EXPECT_TRUE((L * L.transpose()).isApprox(root.run.steps[k].smoothed.cov.dense(), 1e-14));
  }
}

TEST(SquareRoot, OfConstantsWithoutNoiseIsExact) {
  LinearModel<2, 1> m;
  m.F.setIdentity();
  m.Q.setZero();
  m.H << 1.0, 0.0;
  m.R << 4.0;
  Gaussian<2> prior;
  prior.cov << 4.0, 2.0, 2.0, 1.0;  // rank one: the second state is half the first
  const std::vector<Epoch<1>> epochs(3, Epoch<1>{1.0, Mat<1>(1.0)});
  const auto run =
      smooth_square_root(LinearSeries<2, 1>::make(epochs, [&](double) { return m; }).value(), prior)
          .run;
  for (const auto& step : run.steps) {
    EXPECT_NEAR(step.smoothed.mean(0), 0.75,
                1e-15);  // three measurements and a prior, all of variance 4
    EXPECT_NEAR(step.smoothed.mean(1), 0.375, 1e-15);
    EXPECT_NEAR(step.smoothed.cov(0, 0), 1.0, 1e-15);
    EXPECT_NEAR(step.smoothed.cov(1, 0), 0.5, 1e-15);
    EXPECT_NEAR(step.smoothed.cov(1, 1), 0.25, 1e-15);
  }
}

TEST(SquareRoot, GateLeavesOutAndWeighsDownAsTheCovarianceFormDoes) {
  Case c = ill_conditioned(1e-2);
  c.epochs[20].z(0) = 50.0;
  c.epochs[25].z(0) += 0.6;
  const auto series =
      Series::make(c.epochs, std::vector<LinearModel<3, 2>>(30, c.series.model(0))).value();
  const Gate gate{.huber = 3.0, .limit = 20.0};
  const auto root = smooth_square_root(series, c.prior, gate).run;
  const auto plain = smooth_linear(series, c.prior, {.gate = gate});
  EXPECT_EQ(root.readings, plain.readings);
  EXPECT_EQ(root.steps[20].readings, 1);
  for (std::size_t k = 0; k < c.epochs.size(); ++k) {
    const auto &a = root.steps[k], &b = plain.steps[k];
    EXPECT_TRUE(a.filtered.mean.isApprox(b.filtered.mean, 1e-9)) << k;
    EXPECT_TRUE(a.filtered.cov.dense().isApprox(b.filtered.cov.dense(), 1e-9)) << k;
    EXPECT_TRUE(a.smoothed.mean.isApprox(b.smoothed.mean, 1e-8)) << k;
    EXPECT_TRUE(a.smoothed.cov.dense().isApprox(b.smoothed.cov.dense(), 1e-6)) << k;
  }
}

}  // namespace
}  // namespace proofmass::estimate::square_root_test
