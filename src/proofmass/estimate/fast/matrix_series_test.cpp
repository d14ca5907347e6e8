#include "proofmass/estimate/fast/matrix_series.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

#include "proofmass/estimate/filter/linear_gaussian.hpp"

namespace proofmass::estimate::matrix_series_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Three states, two channels, time-varying matrices, missing measurements.
struct Drawn {
  static constexpr int N = 3, M = 2;
  std::size_t size;
  std::vector<double> F, Q, H, R, z, mean, cov, prior_mean{0.3, -1.0, 0.2},
      prior_cov{2.0, 0.3, 0.0, 0.3, 1.0, 0.1, 0.0, 0.1, 0.5};
  std::vector<std::int64_t> which;
  std::vector<double> innovation, innovation_cov;

  explicit Drawn(std::size_t count) : size(count) {
    std::mt19937_64 engine(7);
    std::normal_distribution<double> normal;
    for (std::size_t k = 0; k < size; ++k) {
      which.push_back(static_cast<std::int64_t>(k));
      for (int i = 0; i < N * N; ++i)
        F.push_back(0.2 * normal(engine) + (i % (N + 1) == 0 ? 0.8 : 0.0));
      const double a = normal(engine), b = normal(engine);
      // Rank one: no noise in one direction.
      for (const double row : {a, b, 0.5})
        for (const double column : {a, b, 0.5}) Q.push_back(0.1 * row * column);
      for (int i = 0; i < M * N; ++i) H.push_back(normal(engine));
      R.insert(R.end(), {0.5 + std::abs(a), 0.0, 0.0, 0.2 + std::abs(b)});
      z.push_back(k % 5 == 2 ? nan : normal(engine));
      z.push_back(k % 7 == 2 ? nan : normal(engine));
    }
    mean.resize(size * N);
    cov.resize(size * N * N);
    innovation.resize(size * M);
    innovation_cov.resize(size * M * M);
  }

  [[nodiscard]] MatrixSeries series() const {
    return {.states = N,
            .channels = M,
            .F = {F, which},
            .Q = {Q, which},
            .H = {H, which},
            .R = {R, which},
            .prior_mean = prior_mean,
            .prior_cov = prior_cov,
            .z = z};
  }
  [[nodiscard]] MatrixOutput output() { return {mean, cov, innovation, innovation_cov}; }

  [[nodiscard]] LinearSeries<N, M> fixed_size() const {
    using Rows = Eigen::Matrix<double, N, N, Eigen::RowMajor>;
    std::vector<LinearModel<N, M>> models(size);
    std::vector<Epoch<M>> epochs(size);
    for (std::size_t k = 0; k < size; ++k) {
      models[k].F = Eigen::Map<const Rows>(F.data() + k * N * N);
      models[k].Q = Eigen::Map<const Rows>(Q.data() + k * N * N);
      models[k].H =
          Eigen::Map<const Eigen::Matrix<double, M, N, Eigen::RowMajor>>(H.data() + k * M * N);
      models[k].R << R[k * 4], R[k * 4 + 3];
      epochs[k].z << z[2 * k], z[2 * k + 1];
    }
    return LinearSeries<N, M>::make(std::move(epochs), std::move(models)).value();
  }
  [[nodiscard]] Gaussian<N> prior() const {
    Gaussian<N> out;
    out.mean = Eigen::Map<const Eigen::Vector3d>(prior_mean.data());
    out.cov = Eigen::Map<const Eigen::Matrix3d>(prior_cov.data());
    return out;
  }
};

void expect_near(const PackedGaussian<3>& expected, const Drawn& run, std::size_t k) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(run.mean[k * 3 + static_cast<std::size_t>(i)], expected.mean(i), 1e-11);
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(run.cov[k * 9 + static_cast<std::size_t>(3 * i + j)], expected.cov(i, j), 1e-11);
  }
}

TEST(MatrixSeries, FiltersAsTheFilterOfFixedSize) {
  Drawn run(60);
  const auto summary = run_matrices(run.series(), MatrixPass::filter, 0, run.output());
  ASSERT_TRUE(summary);
  const auto expected = filter_linear(run.fixed_size(), run.prior());
  for (std::size_t k = 0; k < run.size; ++k) expect_near(expected.steps[k].filtered, run, k);
  EXPECT_NEAR(summary->log_likelihood, expected.log_likelihood, 1e-9);
  EXPECT_NEAR(summary->nis, expected.nis, 1e-9);
  EXPECT_EQ(summary->readings, expected.readings);
}

TEST(MatrixSeries, SmoothsTimeVaryingModelsAsTheSmootherOfFixedSize) {
  Drawn run(60);
  ASSERT_TRUE(run_matrices(run.series(), MatrixPass::smooth, 0, run.output()));
  const auto expected = smooth_linear(run.fixed_size(), run.prior());
  for (std::size_t k = 0; k < run.size; ++k) expect_near(expected.steps[k].smoothed, run, k);
}

TEST(MatrixSeries, FixedLagIsTheSmootherOfTheReadingsSoFar) {
  constexpr std::size_t lag = 4, epoch = 20;
  Drawn run(60), part(epoch + lag + 1);
  ASSERT_TRUE(run_matrices(run.series(), MatrixPass::fixed_lag, lag, run.output()));
  ASSERT_TRUE(run_matrices(part.series(), MatrixPass::smooth, 0, part.output()));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(run.mean[epoch * 3 + i], part.mean[epoch * 3 + i], 1e-12);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(run.cov[epoch * 9 + i], part.cov[epoch * 9 + i], 1e-12);
}

TEST(MatrixSeries, CorrelatedChannelsCountAsTheirDecorrelatedOnes) {
  // z = (a + b, b), with a and b independent of variance 1 and 2, contains the same information as
  // (a, b).
  const std::vector<double> F{1.0}, Q{0.0}, x{0.0}, P{10.0}, H{1.0, 0.5}, R{3.0, 2.0, 2.0, 2.0},
      z{1.3, 0.4}, H_apart{0.5, 0.5}, R_apart{1.0, 0.0, 0.0, 2.0}, z_apart{0.9, 0.4};
  const auto run = [&](const auto& H_of, const auto& R_of, const auto& z_of) {
    std::vector<double> mean(1), cov(1), y(2), S(4);
    const MatrixSeries series{.states = 1,
                              .channels = 2,
                              .F = {F},
                              .Q = {Q},
                              .H = {H_of},
                              .R = {R_of},
                              .prior_mean = x,
                              .prior_cov = P,
                              .z = z_of};
    EXPECT_TRUE(run_matrices(series, MatrixPass::filter, 0, {mean, cov, y, S}));
    return std::pair{mean[0], cov[0]};
  };
  const auto together = run(H, R, z), apart = run(H_apart, R_apart, z_apart);
  EXPECT_NEAR(together.first, apart.first, 1e-14);
  EXPECT_NEAR(together.second, apart.second, 1e-14);
  EXPECT_NEAR(apart.second, 1.0 / (0.1 + 0.25 + 0.125), 1e-14);
}

TEST(MatrixSeries, UniformPassesGiveTheSame) {
  constexpr std::size_t size = 5000;
  const std::vector<double> F{1.0, 0.1, 0.0, 1.0}, Q{1e-4, 1e-3, 1e-3, 2e-2}, H{1.0, 0.0}, R{0.3},
      x{0.0, 0.0}, P{5.0, 0.0, 0.0, 5.0};
  std::vector<double> z(size);
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal;
  for (double& value : z) value = normal(engine);
  for (std::size_t k = 900; k < 950; ++k) z[k] = nan;
  const MatrixSeries series{.states = 2,
                            .channels = 1,
                            .F = {F},
                            .Q = {Q},
                            .H = {H},
                            .R = {R},
                            .prior_mean = x,
                            .prior_cov = P,
                            .z = z};
  ASSERT_TRUE(is_uniform(series));
  for (const MatrixPass pass : {MatrixPass::filter, MatrixPass::smooth}) {
    std::vector<double> mean(2 * size), cov(4 * size), y(size), S(size), mean_2 = mean, cov_2 = cov,
                                                                         y_2 = y, S_2 = S;
    const auto fast = run_uniform_matrices(series, pass, {mean, cov, y, S});
    const auto plain = run_matrices(series, pass, 0, {mean_2, cov_2, y_2, S_2});
    ASSERT_TRUE(fast && plain);
    EXPECT_NEAR(fast->log_likelihood, plain->log_likelihood, 1e-7);
    for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(mean[i], mean_2[i], 1e-9);
    for (std::size_t i = 0; i < cov.size(); ++i) EXPECT_NEAR(cov[i], cov_2[i], 1e-9);
    for (std::size_t k = 0; k < size; ++k) {
      EXPECT_EQ(std::isnan(y[k]), std::isnan(z[k]));
      EXPECT_EQ(std::isnan(S[k]), std::isnan(S_2[k]));
    }
  }
}

TEST(MatrixSeries, SaysWhyItCannot) {
  Drawn run(5);
  MatrixSeries wrong = run.series();
  wrong.F.values = wrong.F.values.first(8);
  EXPECT_EQ(run_matrices(wrong, MatrixPass::filter, 0, run.output()).error().code,
            Errc::invalid_argument);
  run.R[4] = run.R[5] = run.R[6] = 0.0;
  run.H[6] = run.H[7] = run.H[8] = 0.0;
  const auto singular = run_matrices(run.series(), MatrixPass::filter, 0, run.output());
  ASSERT_FALSE(singular);
  EXPECT_EQ(singular.error().code, Errc::not_positive_definite);
  EXPECT_NE(singular.error().message.find("epoch 1"), std::string::npos);
  run.Q[2] = nan;
  EXPECT_EQ(run_matrices(run.series(), MatrixPass::filter, 0, run.output()).error().code,
            Errc::not_finite);
  EXPECT_FALSE(is_uniform(run.series()));
}

}  // namespace
}  // namespace proofmass::estimate::matrix_series_test
