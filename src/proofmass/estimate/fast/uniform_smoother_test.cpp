#include "proofmass/estimate/fast/uniform_smoother.hpp"

#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/fast/steady_state.hpp"
#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/filter/reference_smoother_test_support.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate::uniform_smoother_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

LinearModel<4, 1> with_bias_model(double time_constant_s = 100.0) {
  const auto m = pva_bias_model({.motion = {0.005, 1.0, 0.02 * 0.02},
                                 .time_constant_s = time_constant_s,
                                 .bias_psd_m2ps5 = 2.0 * 0.05 * 0.05 / time_constant_s});
  return {m.F, m.Q, m.H, m.R};
}
LinearModel<4, 1> position_read(LinearModel<4, 1> m) {
  m.H << 1.0, 0.0, 0.0, 0.0;
  return m;
}
LinearModel<3, 1> position_read(LinearModel<3, 1> m) {
  m.H << 1.0, 0.0, 0.0;
  return m;
}
const LinearModel<3, 1> three = pva_model({0.005, 1.0, 0.02 * 0.02});

// Without zeros and ones, so that no sparsity pattern matches.
LinearModel<3, 1> dense_model() {
  LinearModel<3, 1> m;
  m.F << 0.9, 0.1, 0.05, -0.2, 0.8, 0.1, 0.03, -0.1, 0.97;
  m.Q << 0.02, 0.003, 0.001, 0.003, 0.03, -0.002, 0.001, -0.002, 0.01;
  m.H << 0.7, -0.4, 1.2;
  m.R << 0.3;
  return m;
}
LinearModel<2, 1> oscillator() {
  LinearModel<2, 1> m;
  m.F << 0.99, 0.1, -0.1, 0.99;
  m.Q << 1e-4, 0.0, 0.0, 2e-4;
  m.H << 1.0, 0.0;
  m.R << 0.05;
  return m;
}
LinearModel<1, 1> level() {
  LinearModel<1, 1> m;
  m.F << 1.0;
  m.Q << 0.3;
  m.H << 1.0;
  m.R << 2.0;
  return m;
}

template <int N>
Gaussian<N> prior(double variance = 0.01) {
  Gaussian<N> x;
  x.cov = variance * Mat<N, N>::Identity();
  x.mean.setConstant(0.1);
  return x;
}

enum class Missing { nothing, a_second, a_few };

std::vector<double> readings(std::size_t count, Missing missing = Missing::nothing) {
  Random random(1, "uniform smoother");
  std::vector<double> z(count);
  for (std::size_t k = 0; k < count; ++k) {
    z[k] = std::sin(0.01 * static_cast<double>(k)) + 0.02 * random.normal();
    if (missing == Missing::a_second && k >= count / 2 && k < count / 2 + 200) z[k] = none;
    if (missing == Missing::a_few && random.uniform() < 0.05) z[k] = none;
  }
  return z;
}

template <int N>
std::vector<Epoch<1>> epochs_of(const std::vector<double>& z) {
  std::vector<Epoch<1>> epochs;
  for (const double reading : z) epochs.push_back({1.0, Mat<1>(reading)});
  return epochs;
}

template <int N>
LinearRun<N, 1> reference(const LinearModel<N, 1>& model,
                          const Gaussian<N>& start,
                          const std::vector<double>& z) {
  return smooth_linear(
      LinearSeries<N, 1>::make(epochs_of<N>(z), [&](double) { return model; }).value(), start);
}

/// Largest differences: of means in standard deviations, of covariances relative to √(Pii Pjj).
struct Apart {
  double means = 0.0, covs = 0.0;
};

template <int N>
void compare(const Mat<N>& mean,
             const Symmetric<N>* cov,
             const PackedGaussian<N>& expected,
             Apart& apart) {
  const Mat<N> std = expected.cov.diagonal().cwiseSqrt();
  for (int i = 0; i < N; ++i) {
    apart.means = std::max(apart.means, std::abs(mean(i) - expected.mean(i)) / std(i));
    for (int j = 0; cov != nullptr && j <= i; ++j)
      apart.covs =
          std::max(apart.covs, std::abs((*cov)(i, j) - expected.cov(i, j)) / (std(i) * std(j)));
  }
}

template <int N>
Apart apart(const UniformRun<N>& run, const LinearRun<N, 1>& expected, bool smooth, bool covs) {
  Apart apart;
  for (std::size_t k = 0; k < run.means.size(); ++k)
    compare<N>(run.means[k], covs ? &run.covariance(k) : nullptr,
               smooth ? expected.steps[k].smoothed : expected.steps[k].filtered, apart);
  return apart;
}

template <int N>
UniformOptions<N> options(Covariances covariances, bool smooth = true) {
  UniformOptions<N> options;
  options.covariances = covariances;
  options.smooth = smooth;
  return options;
}

template <int N>
void expect_equal_to_any_record(const LinearModel<N, 1>& model,
                                const std::vector<double>& z,
                                double means = 1e-12,
                                double covs = 2e-11) {
  const auto expected = reference(model, prior<N>(), z);
  for (const bool smooth : {true, false})
    for (const auto kind :
         {Covariances::everywhere, Covariances::where_they_change, Covariances::none}) {
      const auto run =
          smooth_uniform<N>(model, prior<N>(), std::span(z), options<N>(kind, smooth)).value();
      const Apart off = apart(run, expected, smooth, kind != Covariances::none);
      const auto where = ::testing::Message() << N << " states, " << z.size() << " epochs, smooth "
                                              << smooth << ", " << run.summary.passes();
      EXPECT_LT(off.means, means) << where;
      EXPECT_LT(off.covs, covs) << where;
      EXPECT_EQ(run.summary.readings, expected.readings) << where;
      EXPECT_NEAR(run.summary.nis / expected.nis, 1.0, 1e-11) << where;
      EXPECT_NEAR(run.summary.log_likelihood / expected.log_likelihood, 1.0, 1e-11) << where;
    }
}

TEST(UniformSmoother, IsTheSmootherOfAnyRecordWhereAccelerationIsRead) {
  for (const auto missing : {Missing::nothing, Missing::a_second, Missing::a_few}) {
    expect_equal_to_any_record(three, readings(20'000, missing));
    expect_equal_to_any_record(with_bias_model(), readings(20'000, missing));
  }
}

TEST(UniformSmoother, IsTheSmootherOfAnyRecordWherePositionIsRead) {
  for (const auto missing : {Missing::nothing, Missing::a_few}) {
    expect_equal_to_any_record(position_read(three), readings(20'000, missing), 1e-11, 1e-8);
    expect_equal_to_any_record(position_read(with_bias_model()), readings(20'000, missing), 1e-11,
                               1e-8);
  }
}

TEST(UniformSmoother, IsTheSmootherOfAnyRecordForModelsWithoutAPattern) {
  expect_equal_to_any_record(dense_model(), readings(20'000));
  expect_equal_to_any_record(oscillator(), readings(20'000, Missing::a_second));
  expect_equal_to_any_record(level(), readings(20'000));
}

TEST(UniformSmoother, TakesShortRecords) {
  const auto empty = smooth_uniform<4>(with_bias_model(), prior<4>(), {}).value();
  EXPECT_TRUE(empty.means.empty());
  EXPECT_EQ(empty.summary.log_likelihood, 0.0);
  for (const std::size_t count : {1U, 2U, 3U, 1023U, 1024U, 1025U, 4991U, 4992U, 4993U, 8960U})
    expect_equal_to_any_record(with_bias_model(), readings(count));
}

TEST(UniformSmoother, TakesARecordWithoutAnyReading) {
  const std::vector<double> z(9'000, none);
  const auto run = smooth_uniform<3>(three, prior<3>(), std::span(z)).value();
  EXPECT_EQ(run.summary.readings, 0U);
  EXPECT_EQ(run.summary.log_likelihood, 0.0);
  const auto expected = reference(three, prior<3>(), z);
  EXPECT_LT(apart(run, expected, true, true).covs, 1e-12);
}

TEST(UniformSmoother, GoesSideBySideAndAtConstantGainWhereItMay) {
  const auto z = readings(100'000);
  const auto accel = smooth_uniform<4>(with_bias_model(), prior<4>(), std::span(z)).value().summary;
  EXPECT_GT(accel.side_by_side, 90'000U);
  EXPECT_EQ(accel.constant_gain, 0U) << "position and velocity have no limit";
  const auto model = position_read(with_bias_model());
  const auto position = smooth_uniform<4>(model, prior<4>(), std::span(z)).value().summary;
  EXPECT_EQ(position.constant_gain, 0U) << "the bias's variance takes longer than that to settle";
  const auto quick = position_read(with_bias_model(1.0));
  EXPECT_GT(smooth_uniform<4>(quick, prior<4>(), std::span(z)).value().summary.constant_gain,
            80'000U);
  const auto means =
      smooth_uniform<4>(model, prior<4>(), std::span(z), options<4>(Covariances::none)).value();
  EXPECT_GT(means.summary.constant_gain, 90'000U) << "no gain depends on the bias";
}

TEST(UniformSmoother, GoesBackToVaryingGainsAtAGap) {
  auto z = readings(60'000);
  std::fill_n(z.begin() + 30'000, 500, none);
  z[50'000] = none;
  const auto model = position_read(three);
  const auto run =
      smooth_uniform<3>(model, prior<3>(), std::span(z), options<3>(Covariances::none)).value();
  EXPECT_GT(run.summary.constant_gain, 40'000U);
  EXPECT_GT(run.summary.one_by_one, 2U * 3968U);
  EXPECT_LT(apart(run, reference(model, prior<3>(), z), true, false).means, 1e-9);
}

// After a gap of 10 s the uncertainty is so large that P − P Λ P has no correct digit.
TEST(UniformSmoother, KeepsItsDigitsBehindAGapAndAWideStart) {
  auto z = readings(4'500);
  std::fill_n(z.begin() + 1'000, 2'000, none);
  const auto model = position_read(three);
  Gaussian<3> wide;
  wide.cov = 1e6 * Mat<3, 3>::Identity();
  const auto epochs = epochs_of<3>(z);
  const auto series = LinearSeries<3, 1>::make(epochs, [&](double) { return model; }).value();
  const test::QuadRun exact = test::quad_smoother(series, epochs, wide);
  const auto run = smooth_uniform<3>(model, wide, std::span(z)).value();
  Apart off;
  for (std::size_t k = 0; k < z.size(); ++k) {
    PackedGaussian<3> expected;
    for (std::size_t i = 0; i < 3; ++i) {
      expected.mean(static_cast<int>(i)) = static_cast<double>(exact.smoothed[k].mean(i));
      for (std::size_t j = 0; j <= i; ++j)
        expected.cov(static_cast<int>(i), static_cast<int>(j)) =
            static_cast<double>(exact.smoothed[k].cov(i, j));
    }
    compare<3>(run.means[k], &run.covariance(k), expected, off);
  }
  EXPECT_LT(off.means, 1e-8);
  EXPECT_LT(off.covs, 1e-8);
}

// A filter that takes small changes of P as convergence would freeze this bias's variance 5 % off:
// with a time constant of 100 s and 200 measurements a second each change is small.
TEST(UniformSmoother, DoesNotFreezeWhatStillMovesSlowly) {
  const auto model = position_read(with_bias_model());
  Gaussian<4> start = prior<4>();
  start.cov(3, 3) = 0.5;
  const auto z = readings(600'000);
  const auto run = smooth_uniform<4>(model, start, std::span(z)).value();
  const double limit = steady_state(model).value().filtered_variance(3).value();
  EXPECT_NEAR(limit, 0.05 * 0.05, 1e-12);
  // The bias is not measured: its variance decays as φ²ᵏ.
  for (std::size_t k = 0; k < z.size(); k += 777) {
    const double expected =
        limit + (0.5 - limit) * std::exp(-2.0 * 0.005 * static_cast<double>(k) / 100.0);
    ASSERT_NEAR(run.covariance(k)(3, 3) / expected, 1.0, 1e-9) << "k = " << k;
  }
  EXPECT_NEAR(run.covariance(599'999)(3, 3) / limit, 1.0, 1e-9);
  EXPECT_GT(run.summary.constant_gain, 200'000U);
  EXPECT_GT(run.summary.side_by_side, 200'000U);
}

TEST(UniformSmoother, KeepsFewCovariancesOnceTheyStay) {
  const auto z = readings(100'000);
  const auto run = smooth_uniform<3>(position_read(three), prior<3>(), std::span(z)).value();
  EXPECT_EQ(run.summary.covariances.size(), z.size());
  EXPECT_LT(run.summary.covariances.kept(), 2'500U);
}

TEST(UniformSmoother, ReportsInnovationsAndTheirVariances) {
  const auto z = readings(10'000, Missing::a_second);
  for (const auto& model : {three, position_read(three)})
    for (const bool smooth : {true, false}) {
      auto wanted = options<3>(Covariances::none, smooth);
      wanted.innovations = true;
      const auto run = smooth_uniform<3>(model, prior<3>(), std::span(z), wanted).value();
      const auto expected = reference(model, prior<3>(), z);
      for (std::size_t k = 0; k < z.size(); ++k) {
        if (std::isnan(z[k])) {
          ASSERT_TRUE(std::isnan(run.innovation[k]) && std::isnan(run.innovation_variance[k]));
          continue;
        }
        ASSERT_NEAR(run.innovation_variance[k] / expected.steps[k].innovation_variance(0), 1.0,
                    1e-10);
        ASSERT_NEAR(run.innovation[k], expected.steps[k].innovation(0), 1e-11) << "k = " << k;
      }
    }
}

TEST(UniformSmoother, AddsAnInputThatStays) {
  const auto m = pva_bias_model(
      {.motion = {0.005, 1.0, 0.02 * 0.02}, .time_constant_s = 10.0, .bias_psd_m2ps5 = 1e-4});
  const auto z = readings(9'000);
  std::vector<Epoch<1, 1>> epochs;
  for (const double reading : z) epochs.push_back({0.005, Mat<1>(reading), Mat<1>(0.3)});
  const auto expected = smooth_linear(
      LinearSeries<4, 1, 1>::make(epochs, [&](double) { return m; }).value(), prior<4>());
  auto with_input = options<4>(Covariances::everywhere);
  with_input.input = m.B * 0.3;
  const auto run = smooth_uniform<4>(m, prior<4>(), std::span(z), with_input).value();
  EXPECT_LT(apart(run, expected, true, true).means, 1e-12);
}

TEST(UniformSmoother, SaysWhatItCannotUse) {
  auto z = readings(10'000);
  z[5'000] = -std::numeric_limits<double>::infinity();
  const auto infinite = smooth_uniform<3>(three, prior<3>(), std::span(z));
  ASSERT_FALSE(infinite.has_value());
  EXPECT_EQ(infinite.error().code, Errc::not_finite);
  EXPECT_TRUE(infinite.error().message.starts_with("epoch 5000: ")) << infinite.error().message;

  auto worthless = three;
  worthless.R(0) = 0.0;
  EXPECT_EQ(smooth_uniform<3>(worthless, prior<3>(), {}).error().code, Errc::not_positive_definite);
  auto unknown = three;
  unknown.Q(0, 0) = none;
  EXPECT_EQ(smooth_uniform<3>(unknown, prior<3>(), {}).error().code, Errc::not_finite);
}

}  // namespace
}  // namespace proofmass::estimate::uniform_smoother_test
