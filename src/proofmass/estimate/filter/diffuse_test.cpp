#include <array>
#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/filter/reference_smoother_test_support.hpp"

namespace proofmass::estimate::diffuse_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

LinearModel<1, 1> level_model(double) {
  LinearModel<1, 1> m;
  m.F << 1.0;
  m.Q << 8.253;
  m.H << 1.0;
  m.R << 1.993;
  return m;
}

// The local level of the package KFAS (J. Helske, Journal of Statistical Software 78 (2017)),
// computed in R: y = 10.2394, then nine times 1. One row per epoch: F, att, Ptt, alphahat, V.
struct LevelRow {
  double F, att, Ptt, alphahat, V;
};
constexpr std::array<LevelRow, 10> kfas_level{
    {{infinite, 10.2394, 1.993, 8.69269189482201, 1.65936477978876},
     {12.239, 2.50454483209413, 1.66845967807828, 2.28778372019385, 1.42808320855318},
     {11.9144596780783, 1.25167384265698, 1.65961946010793, 1.21557953089427, 1.4216017878374},
     {11.9056194601079, 1.04213018651369, 1.65937191678189, 1.03608877283924, 1.42142015300846},
     {11.9053719167819, 1.00705273739524, 1.6593649797953, 1.00604138771061, 1.42141506687939},
     {11.9053649797953, 1.00118065306293, 1.65936478539373, 1.00101134968464, 1.42141506687939},
     {11.9053647853937, 1.00019764548141, 1.65936477994583, 1.0001693041059, 1.42142015300846},
     {11.9053647799458, 1.00003308654978, 1.65936477979316, 1.00002834572536, 1.4216017878374},
     {11.9053647797932, 1.00000553880498, 1.65936477978888, 1.00000476680865, 1.42808320855317},
     {11.9053647797889, 1.00000092721546, 1.65936477978876, 1.00000092721546, 1.65936477978876}}};

TEST(DiffuseStart, AgreesWithAnIndependentPackageOnALocalLevelToAllItsDigits) {
  std::vector<Epoch<1>> epochs(10, Epoch<1>{1.0, Mat<1>(1.0)});
  epochs[0].z(0) = 10.2394;
  const auto series = LinearSeries<1, 1>::make(epochs, level_model).value();
  for (const Smoother smoother : {Smoother::bryson_frazier, Smoother::rauch_tung_striebel}) {
    const auto run = smooth_linear(series, Start<1>::diffuse(), {.smoother = smoother});
    EXPECT_NEAR(run.log_likelihood, -23.0163218509366, 5e-14 * 23);
    EXPECT_EQ(run.diffuse_readings, 1U);
    EXPECT_EQ(run.readings, 9U);
    for (std::size_t k = 0; k < epochs.size(); ++k) {
      const auto& step = run.steps[k];
      if (k == 0)
        EXPECT_EQ(step.innovation_variance(0), infinite);
      else
        EXPECT_NEAR(step.innovation_variance(0), kfas_level[k].F, 1e-13);
      EXPECT_NEAR(step.filtered.mean(0), kfas_level[k].att, 1e-14 * 10) << "k = " << k;
      EXPECT_NEAR(step.filtered.cov(0, 0), kfas_level[k].Ptt, 1e-14) << "k = " << k;
      EXPECT_NEAR(step.smoothed.mean(0), kfas_level[k].alphahat, 1e-14 * 10) << "k = " << k;
      EXPECT_NEAR(step.smoothed.cov(0, 0), kfas_level[k].V, 2e-14) << "k = " << k;
    }
  }
}

// A level and a slope with random walks, with the level measured and a known input to the slope.
LinearModel<2, 1, 1> trend_model(double dt_s) {
  LinearModel<2, 1, 1> m;
  m.F << 1.0, dt_s, 0.0, 1.0;
  m.Q << 0.3 * dt_s, 0.02, 0.02, 0.1 * dt_s;
  m.H << 1.0, 0.0;
  m.R << 0.7;
  m.B << 0.5 * dt_s * dt_s, dt_s;
  return m;
}

using TrendEpochs = std::vector<Epoch<1, 1>>;
TrendEpochs trend(const std::vector<double>& z) {
  TrendEpochs epochs;
  for (std::size_t k = 0; k < z.size(); ++k)
    epochs.push_back({k % 3 == 0 ? 0.5 : 1.0, Mat<1>(z[k]), Mat<1>(0.1 * static_cast<double>(k))});
  return epochs;
}

// Compares every smoothed moment, lag-one covariance and the likelihood with 128-bit least squares
// with a flat prior; every filtered moment with least squares over the measurements so far.
template <int N, int M, int U>
void expect_least_squares(const std::vector<Epoch<M, U>>& epochs,
                          const LinearSeries<N, M, U>& series,
                          const Start<N>& start,
                          std::size_t determined_from,
                          double tolerance = 1e-11) {
  std::vector<std::optional<double>> variance(static_cast<std::size_t>(N));
  for (int i = 0; i < N; ++i)
    if (start.basis.row(i).isZero()) variance[static_cast<std::size_t>(i)] = start.proper.cov(i, i);
  const auto check = [&](const PackedGaussian<N>& x, const test::QuadBatch& batch,
                         std::size_t epoch) {
    for (int i = 0; i < N; ++i) {
      const std::size_t at = epoch * N + static_cast<std::size_t>(i);
      const double std = std::sqrt(static_cast<double>(batch.cov(at, at)));
      EXPECT_NEAR(x.mean(i), static_cast<double>(batch.mean(at)), tolerance * std)
          << "state " << i << " of epoch " << epoch;
      for (int j = 0; j <= i; ++j) {
        const std::size_t to = epoch * N + static_cast<std::size_t>(j);
        const double scale = std * std::sqrt(static_cast<double>(batch.cov(to, to)));
        EXPECT_NEAR(x.cov(i, j), static_cast<double>(batch.cov(at, to)), tolerance * scale)
            << "entry " << i << ", " << j << " of epoch " << epoch;
      }
    }
  };
  const auto all = test::least_squares(series, epochs, variance, epochs.size());
  for (const Smoother smoother : {Smoother::bryson_frazier, Smoother::rauch_tung_striebel}) {
    const auto run = smooth_linear(series, start, {.smoother = smoother, .lag_one = true});
    EXPECT_NEAR(run.log_likelihood, all.log_likelihood,
                1e-10 + 1e-12 * std::abs(all.log_likelihood));
    for (std::size_t k = 0; k < epochs.size(); ++k) {
      check(run.steps[k].smoothed, all, k);
      if (k >= determined_from && smoother == Smoother::bryson_frazier)
        check(run.steps[k].filtered, test::least_squares(series, epochs, variance, k + 1), k);
      EXPECT_EQ(run.steps[k].diffuse_directions > 0, k < determined_from);
      if (k + 1 == epochs.size()) continue;
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) {
          const std::size_t at = (k + 1) * N + static_cast<std::size_t>(i);
          const std::size_t to = k * N + static_cast<std::size_t>(j);
          const double scale = std::sqrt(static_cast<double>(all.cov(at, at)) *
                                         static_cast<double>(all.cov(to, to)));
          EXPECT_NEAR(run.lag_one[k](i, j), static_cast<double>(all.cov(at, to)), tolerance * scale)
              << "lag one " << i << ", " << j << " from epoch " << k;
        }
    }
  }
}

TEST(DiffuseStart, OfATrendEqualsLeastSquaresWithNoPrior) {
  const auto epochs = trend({1.2, 2.9, 2.4, 5.5, 7.0, 6.1, 9.3, 11.0});
  expect_least_squares(epochs, LinearSeries<2, 1, 1>::make(epochs, trend_model).value(),
                       Start<2>::diffuse(), 1);
}

TEST(DiffuseStart, ToleratesMissingMeasurementsAtTheStart) {
  const auto epochs = trend({none, none, 2.4, none, none, 6.1, none, 11.0, none});
  expect_least_squares(epochs, LinearSeries<2, 1, 1>::make(epochs, trend_model).value(),
                       Start<2>::diffuse(), 5);
}

TEST(DiffuseStart, MayBeDiffuseInOneStateOnly) {
  const auto epochs = trend({none, 2.9, 2.4, none, 7.0});
  Gaussian<2> known;
  known.cov(0, 0) = 0.4;
  expect_least_squares(epochs, LinearSeries<2, 1, 1>::make(epochs, trend_model).value(),
                       Start<2>::diffuse({1}, known), 1);
}

// Four states, one of them known; three channels measure mixtures of them, with gaps.
LinearModel<4, 3, 1> mixed_model(double dt_s) {
  LinearModel<4, 3, 1> m;
  m.F << 1.0, dt_s, 0.1, 0.0, -0.2, 0.9, 0.0, 0.1, 0.0, 0.3, 1.0, -0.1, 0.2, 0.0, 0.1, 0.8;
  Mat<4, 4> root;
  root << 0.3, 0.1, 0.0, 0.2, 0.0, 0.4, 0.1, 0.0, 0.1, 0.0, 0.2, 0.0, 0.0, 0.1, 0.0, 0.3;
  m.Q = dt_s * root * root.transpose();
  m.H << 1.0, 0.5, 0.0, 0.0, 0.0, 1.0, -0.5, 0.0, 1.0, 0.5, 0.0, 0.2;
  m.R << 0.04, 0.25, 0.1;
  m.B << 1.0, 0.0, -0.5, 0.2;
  return m;
}

TEST(DiffuseStart, OfSeveralStatesInSeveralChannelsEqualsLeastSquaresWithNoPrior) {
  const auto at = [](double z0, double z1, double z2, double u) {
    return Epoch<3, 1>{1.0, Mat<3>(z0, z1, z2), Mat<1>(u)};
  };
  const std::vector<Epoch<3, 1>> epochs{at(none, 0.3, none, 1.0),  at(1.0, none, 0.9, 0.2),
                                        at(none, none, none, -.5), at(0.4, 0.2, 0.1, 0.3),
                                        at(none, 0.7, -0.3, 0.0),  at(0.2, none, 0.5, 1.0)};
  Gaussian<4> known;
  known.cov(3, 3) = 0.6;
  expect_least_squares(epochs, LinearSeries<4, 3, 1>::make(epochs, mixed_model).value(),
                       Start<4>::diffuse({0, 1, 2}, known), 1);
  expect_least_squares(epochs, LinearSeries<4, 3, 1>::make(epochs, mixed_model).value(),
                       Start<4>::diffuse(), 3);
}

// Measurements every 5 ms contain little information on the acceleration: the start is determined
// long before it is precise, and no digits may be lost meanwhile. The level is far from 0.
TEST(DiffuseStart, OfPositionSpeedAndAccelerationAtTwoHundredReadingsASecondLosesFewDigits) {
  constexpr double h = 0.005;
  LinearModel<3, 1> m;
  m.F << 1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0;
  m.Q << h * h * h * h * h / 20.0, h * h * h * h / 8.0, h * h * h / 6.0, h * h * h * h / 8.0,
      h * h * h / 3.0, h * h / 2.0, h * h * h / 6.0, h * h / 2.0, h;
  m.H << 1.0, 0.0, 0.0;
  m.R << 1e-4;
  std::vector<Epoch<1>> epochs(20);
  for (std::size_t k = 0; k < epochs.size(); ++k)
    epochs[k] = {
        h, Mat<1>(k < 3 || k % 7 == 4 ? none : 100.0 + std::sin(0.1 * static_cast<double>(k)))};
  expect_least_squares(epochs, LinearSeries<3, 1>::make(epochs, [&](double) { return m; }).value(),
                       Start<3>::diffuse(), 6, 1e-9);
}

// Both conventions, compared with the limit of an increasing variance κ: ln p + ½ d ln κ.
TEST(DiffuseStart, LikelihoodIsTheLimitOfLargeVariances) {
  const auto epochs = trend({1.2, 2.9, none, 5.5, 7.0});
  const auto series = LinearSeries<2, 1, 1>::make(epochs, trend_model).value();
  const auto run = filter_linear(series, Start<2>::diffuse());
  Gaussian<2> wide;
  constexpr double kappa = 1e9;
  wide.cov.diagonal().setConstant(kappa);
  const double limit = filter_linear(series, wide).log_likelihood + std::log(kappa);
  EXPECT_NEAR(run.log_likelihood - std::log(2.0 * std::numbers::pi), limit, 1e-6);
}

TEST(DiffuseStart, WhatNoReadingDeterminesIsInfiniteBeforeAndAfterSmoothing) {
  const auto epochs = trend({none, 2.9, none});
  const auto run = smooth_linear(LinearSeries<2, 1, 1>::make(epochs, trend_model).value(),
                                 Start<2>::diffuse(), {.lag_one = true});
  EXPECT_EQ(run.steps[0].diffuse_directions, 2);
  EXPECT_EQ(run.steps[1].diffuse_directions, 1);
  EXPECT_EQ(run.steps[2].diffuse_directions, 1);
  EXPECT_TRUE(run.steps[1].filtered.determined(0));
  EXPECT_NEAR(run.steps[1].filtered.cov(0, 0), 0.7, 1e-14);
  EXPECT_FALSE(run.steps[1].filtered.determined(1));
  EXPECT_FALSE(run.steps[2].filtered.determined(0));
  EXPECT_FALSE(run.steps[0].smoothed.determined(0));
  EXPECT_TRUE(run.steps[1].smoothed.determined(0));
  EXPECT_NEAR(run.steps[1].smoothed.mean(0), 2.9, 1e-14);
  EXPECT_NEAR(run.steps[1].smoothed.cov(0, 0), 0.7, 1e-14);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_FALSE(run.steps[k].smoothed.determined(1)) << k;
  EXPECT_EQ(run.steps[0].smoothed.cov(0, 1), -infinite);
  EXPECT_EQ(run.lag_one[1](1, 1), infinite);
  // With both states unknown, the measurement one step of 1 later affects both equally:
  // cov(level[1], slope[0]) = R κ / 2κ, since level[1] = level[0] + slope[0] + ….
  EXPECT_NEAR(run.lag_one[0](0, 1), 0.35, 1e-14);
}

TEST(DiffuseStart, IsUndeterminedWithoutMeasurements) {
  const auto epochs = trend({none, none});
  const auto run =
      smooth_linear(LinearSeries<2, 1, 1>::make(epochs, trend_model).value(), Start<2>::diffuse());
  EXPECT_EQ(run.log_likelihood, 0.0);
  EXPECT_EQ(run.diffuse_readings, 0U);
  for (const auto& step : run.steps) {
    EXPECT_FALSE(step.smoothed.determined(0));
    EXPECT_FALSE(step.smoothed.determined(1));
  }
}

// A gate cannot reject measurements without a prediction; it rejects others.
TEST(DiffuseStart, ReadingsThatDetermineItPassAnyGate) {
  const auto epochs = trend({1e6, 1e6 + 2.0, 1e6 + 4.0, -1e6, 1e6 + 7.0});
  const auto run = smooth_linear(LinearSeries<2, 1, 1>::make(epochs, trend_model).value(),
                                 Start<2>::diffuse(), {.gate = {.limit = 6.0}});
  EXPECT_EQ(run.diffuse_readings, 2U);
  EXPECT_EQ(run.steps[3].readings, 0);
  EXPECT_NEAR(run.steps[3].smoothed.mean(0), 1e6 + 5.5, 2.0);
}

TEST(DiffuseStart, AReadingOfLittleWeightIsAReadingOfLargerVariance) {
  const auto epochs = trend({1.2, 2.9, 2.4, 25.5, 7.0});
  std::vector<LinearModel<2, 1, 1>> models;
  for (const auto& e : epochs) models.push_back(trend_model(e.dt_s));
  const auto series = LinearSeries<2, 1, 1>::make(epochs, models).value();
  const auto gated = smooth_linear(series, Start<2>::diffuse(), {.gate = {.huber = 2.0}});
  const double expected = gated.steps[3].innovation_variance(0);
  const double off = std::abs(gated.steps[3].innovation(0)) / std::sqrt(expected);
  ASSERT_GT(off, 2.0);
  models[3].R(0) += expected * (off / 2.0 - 1.0);
  const auto wider =
      smooth_linear(LinearSeries<2, 1, 1>::make(epochs, models).value(), Start<2>::diffuse());
  ASSERT_LT(
      std::abs(gated.steps[4].innovation(0)) / std::sqrt(gated.steps[4].innovation_variance(0)),
      2.0);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    const auto &a = gated.steps[k].smoothed, &b = wider.steps[k].smoothed;
    EXPECT_TRUE(a.mean.isApprox(b.mean, 1e-12)) << "k = " << k;
    EXPECT_TRUE(a.cov.dense().isApprox(b.cov.dense(), 1e-12)) << "k = " << k;
  }
}

// Position from accelerations only: its initial value is never observable.
TEST(DiffuseStart, AnUnobservableStateStaysUndeterminedAndDoesNotAffectOthers) {
  LinearModel<2, 1> m;
  m.F << 1.0, 0.1, 0.0, 0.99;
  m.Q << 1e-3, 0.0, 0.0, 0.1;
  m.H << 0.0, 1.0;
  m.R << 0.5;
  std::vector<Epoch<1>> epochs(2000);
  for (std::size_t k = 0; k < epochs.size(); ++k)
    epochs[k] = {0.1, Mat<1>(std::sin(0.1 * static_cast<double>(k)))};
  const auto series = LinearSeries<2, 1>::make(epochs, [&](double) { return m; }).value();
  const auto both = smooth_linear(series, Start<2>::diffuse());
  Gaussian<2> placed;
  const auto speed_only = smooth_linear(series, Start<2>::diffuse({1}, placed));
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    EXPECT_FALSE(both.steps[k].smoothed.determined(0));
    EXPECT_NEAR(both.steps[k].smoothed.mean(1), speed_only.steps[k].smoothed.mean(1), 1e-13);
    EXPECT_NEAR(both.steps[k].smoothed.cov(1, 1), speed_only.steps[k].smoothed.cov(1, 1), 1e-13);
    EXPECT_TRUE(speed_only.steps[k].smoothed.determined(0));
  }
  EXPECT_NEAR(both.log_likelihood, speed_only.log_likelihood, 1e-10);
}

TEST(DiffuseStart, AGaussianIsAStartWithoutDiffuseStates) {
  const auto epochs = trend({1.2, none, 2.4});
  Gaussian<2> known;
  known.cov << 0.4, 0.1, 0.1, 0.9;
  const auto series = LinearSeries<2, 1, 1>::make(epochs, trend_model).value();
  const auto plain = smooth_linear(series, known),
             none_diffuse = smooth_linear(series, Start<2>(known));
  EXPECT_EQ(plain.log_likelihood, none_diffuse.log_likelihood);
  EXPECT_EQ(plain.diffuse_readings, 0U);
  EXPECT_EQ(plain.steps[0].smoothed.cov, none_diffuse.steps[0].smoothed.cov);
}

}  // namespace
}  // namespace proofmass::estimate::diffuse_test
