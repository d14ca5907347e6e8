#include "proofmass/characterise/runs/scatter.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/characterise/runs/blocks.hpp"
#include "proofmass/characterise/runs/run_test_support.hpp"

namespace proofmass::characterise::run_scatter_test {
namespace {

using Eigen::Index;

RunScatter level_scatter(const test::RunSource& source) {
  const test::MadeRuns made = test::made_of(source);
  const RunBlocks blocks = run_blocks(made.runs).value();
  const RunNoise noise = fit_run_noise(residuals(blocks), blocks.duration_s);
  const std::vector<double> levels(blocks.level.begin(), blocks.level.end());
  return run_scatter(levels, noise.allan_variance(blocks.duration_s));
}

struct Coverage {
  double covered = 0.0, from_zero = 0.0;
  std::vector<double> p;  ///< ascending
};

Coverage coverage_of(test::RunSource source, int sets) {
  Coverage coverage;
  for (int k = 0; k < sets; ++k, ++source.seed) {
    const RunScatter found = level_scatter(source);
    const double lower = *found.between_std.lower_95, upper = *found.between_std.upper_95;
    if (lower <= source.between_std && source.between_std <= upper) coverage.covered += 1.0 / sets;
    if (lower == 0.0) coverage.from_zero += 1.0 / sets;
    coverage.p.push_back(found.p);
  }
  std::ranges::sort(coverage.p);
  return coverage;
}

RunNoise noise_of(const RunNoiseTerm& term) {
  RunNoise noise;
  noise.duration_s = 1.0;
  noise.models.push_back({{term}, Eigen::VectorXd::Ones(1), Eigen::MatrixXd::Zero(1, 1), 1.0});
  return noise;
}

TEST(RunScatter, IntervalHoldsTheTruthInNinetyFivePerCent) {
  for (const double between : {0.25, 0.625}) {
    const Coverage ten = coverage_of({.between_std = between}, 300);
    EXPECT_GE(ten.covered, 0.92) << between;
    EXPECT_LE(ten.covered, 0.98) << between;
  }
}

TEST(RunScatter, OfRunsThatDoNotDifferBeginsAtZeroAndPIsNearlyUniform) {
  const Coverage none = coverage_of({.seed = 5000}, 300);
  EXPECT_GE(none.from_zero, 0.95);
  double furthest = 0.0;
  for (std::size_t k = 0; k < none.p.size(); ++k)
    furthest = std::max(furthest, std::abs(none.p[k] - (static_cast<double>(k) + 0.5) / 300.0));
  // Kolmogorov's 5 % limit is 0.079; allowance for coloured noise increases p slightly.
  EXPECT_LT(furthest, 0.15);
  EXPECT_LE(std::ranges::count_if(none.p, [](double p) { return p < 0.05; }), 25);
}

TEST(RunScatter, WithNoNoiseWithinIsTheSampleStandardDeviationWithItsChiSquareInterval) {
  // 2 1 4 3 5: s² = 2.5; χ²(4) at 0.025 and 0.975 is 0.484419 and 11.143287 (NIST/SEMATECH
  // e-Handbook, table 1.3.6.7.4).
  const std::vector<double> values{2.0, 1.0, 4.0, 3.0, 5.0};
  const RunScatter found = run_scatter(values, std::vector<VarianceEstimate>{{0.0, 0.0, 1.0}});
  EXPECT_DOUBLE_EQ(found.mean, 3.0);
  EXPECT_DOUBLE_EQ(found.between_std.value, std::sqrt(2.5));
  EXPECT_NEAR(*found.between_std.lower_95, std::sqrt(10.0 / 11.143287), 1e-6);
  EXPECT_NEAR(*found.between_std.upper_95, std::sqrt(10.0 / 0.484419), 1e-5);
  EXPECT_EQ(found.p, 0.0);
}

TEST(RunScatter, WithNoiseKnownIsCochransTestAndTheQProfile) {
  const std::vector<double> values{2.0, 1.0, 4.0, 3.0, 5.0};
  const RunScatter found = run_scatter(values, std::vector<VarianceEstimate>{{0.5, 0.0, 1.0}});
  EXPECT_DOUBLE_EQ(found.between_std.value, std::sqrt(2.0));
  // P[χ²(4) > 20] = e⁻¹⁰ (1 + 10).
  EXPECT_NEAR(found.p, 11.0 * std::exp(-10.0), 1e-12);
  EXPECT_NEAR(*found.between_std.lower_95, std::sqrt(10.0 / 11.143287 - 0.5), 1e-6);
  EXPECT_NEAR(*found.between_std.upper_95, std::sqrt(10.0 / 0.484419 - 0.5), 1e-5);
}

TEST(RunScatter, OfValuesThatAgreeTooWellStillHasAnUpperEnd) {
  const RunScatter found = run_scatter(std::vector<double>{1.0, 1.0, 1.0},
                                       std::vector<VarianceEstimate>{{1.0, 0.1, 1.0}});
  EXPECT_EQ(found.between_std.value, 0.0);
  EXPECT_EQ(*found.between_std.lower_95, 0.0);
  EXPECT_GT(*found.between_std.upper_95, 1.0);
  EXPECT_GT(found.p, 0.999);
}

TEST(RunTrend, IsLeastSquaresWithStudentsT) {
  // 1 3 2 5 4 5 against 0 … 5: slope 0.74286, s² = Σ e² / 4 = 3.67619 / 4 … by the normal
  // equations.
  const RunTrend trend = run_trend(std::vector<double>{1.0, 3.0, 2.0, 5.0, 4.0, 5.0});
  const double slope = 13.0 / 17.5;
  const double left = 40.0 / 3.0 - 13.0 * slope;
  EXPECT_NEAR(trend.per_run.value, slope, 1e-12);
  EXPECT_NEAR(trend.per_run.std, std::sqrt(left / 4.0 / 17.5), 1e-12);
  // For Student's t with 4 degrees of freedom, P[|T| > t] = 1 − u (3 − u²) / 2, u = t / √(4 + t²).
  const double t = trend.per_run.value / trend.per_run.std, u = t / std::sqrt(4.0 + t * t);
  EXPECT_NEAR(trend.p, 1.0 - 0.5 * u * (3.0 - u * u), 1e-12);
}

TEST(RunTrend, OfEqualLevelsIsNone) {
  const RunTrend trend = run_trend(std::vector<double>{2.0, 2.0, 2.0, 2.0});
  EXPECT_EQ(trend.per_run.value, 0.0);
  EXPECT_EQ(trend.p, 1.0);
}

TEST(RunNoise, HasTheAllanVariancesOfIeee952) {
  const double tau = 0.3;
  EXPECT_NEAR(noise_of({RunNoiseKind::white}).allan_variance(tau)[0].value, 1.0 / tau, 1e-12);
  EXPECT_NEAR(noise_of({RunNoiseKind::flicker}).allan_variance(tau)[0].value,
              2.0 * std::numbers::ln2 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(noise_of({RunNoiseKind::random_walk}).allan_variance(tau)[0].value, tau / 3.0, 1e-12);
  // Markov process of unit variance: σ²(τ) = (T/τ)² (2τ/T − 3 + 4 e^(−τ/T) − e^(−2τ/T)).
  const double T = 0.1, x = tau / T;
  EXPECT_NEAR(noise_of({RunNoiseKind::markov, T}).allan_variance(tau)[0].value,
              (2.0 * x - 3.0 + 4.0 * std::exp(-x) - std::exp(-2.0 * x)) / (x * x), 1e-12);
}

TEST(RunNoise, OfARandomWalkHasTheOrdinatesOfItsCovariance) {
  // Sums of w in 16 × 64 steps, averaged by 16: exact covariance of the block means, then the
  // transform.
  const Index n = 64, m = 16, N = n * m;
  Eigen::MatrixXd A(n, N);
  for (Index b = 0; b < n; ++b)
    for (Index k = 0; k < N; ++k)
      A(b, k) = std::clamp(static_cast<double>((b + 1) * m - k) / static_cast<double>(m), 0.0, 1.0);
  const Eigen::MatrixXd z = cosine_coefficients(A / std::sqrt(static_cast<double>(N)));
  const Eigen::VectorXd direct = z.rowwise().squaredNorm();
  const Eigen::VectorXd found = noise_of({RunNoiseKind::random_walk}).ordinates(n);
  for (Index k = 0; k < n - 1; ++k) EXPECT_NEAR(found(k) / direct(k), 1.0, 0.01) << k;
}

TEST(RunNoise, FindsTheRandomWalkOfManyRuns) {
  Eigen::MatrixXd y(64, 200);
  for (Index i = 0; i < y.cols(); ++i) {
    const auto seed = static_cast<unsigned>(i);
    const test::Series fine = test::sum_of({test::white(1.0, 16.0, 1024, 10000 + seed),
                                            test::random_walk(0.2, 16.0, 1024, 20000 + seed)});
    for (Index b = 0; b < 64; ++b) {
      double sum = 0.0;
      for (Index k = 0; k < 16; ++k) sum += fine[static_cast<std::size_t>(b * 16 + k)];
      y(b, i) = sum / 16.0;
    }
  }
  y.colwise() -= y.rowwise().mean().eval();
  const RunNoise noise = fit_run_noise(y, 64.0);
  const double truth = 1.0 / 64.0 + 0.04 * 64.0 / 3.0;
  EXPECT_NEAR(mean_variance(noise.allan_variance(64.0)) / truth, 1.0,
              0.2);  // three standard deviations
}

TEST(RunBlocks, OfRunsAtRatesApartByAHundredthShareOneTime) {
  test::MadeRuns made;
  std::vector<double> rates{100.0, 100.9, 99.2};
  for (const double rate : rates) {
    test::Series y(static_cast<std::size_t>(60.0 * rate));
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = std::sin(0.2 * static_cast<double>(k) / rate);
    made.series.push_back(y);
  }
  test::make_views(made, 100.0);
  for (std::size_t i = 0; i < rates.size(); ++i) made.runs[i].rate_hz = rates[i];
  const RunBlocks blocks = run_blocks(made.runs).value();
  const Eigen::MatrixXd left = residuals(blocks);
  EXPECT_LT(left.cwiseAbs().maxCoeff(), 0.002);  // 0.1 if interpreted by index
}

TEST(RunBlocks, IgnoresMissingSamples) {
  test::MadeRuns made = test::made_of({.runs = 4, .samples = 1024});
  for (test::Series& y : made.series)
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = std::exp(-static_cast<double>(k) / 200.0);
  for (std::size_t k = 0; k < 300; ++k) made.series[1][k] = std::nan("");
  for (double& y : made.series[3]) y += 5.0;
  test::make_views(made, 8.0);
  const RunBlocks blocks = run_blocks(made.runs).value();
  EXPECT_NEAR(blocks.level(1), blocks.level(0), 1e-4);
  EXPECT_NEAR(blocks.level(3) - blocks.level(0), 5.0, 1e-4);
}

}  // namespace
}  // namespace proofmass::characterise::run_scatter_test
