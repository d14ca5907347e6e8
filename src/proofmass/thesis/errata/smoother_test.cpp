#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "proofmass/estimate/models/bias_models.hpp"

// docs/errata.md, section 4.1.5: the smoother, for a first-order autoregressive level,
//
//   x[k] = F x[k−1] + w,   z[k] = x[k] + v,   x[0] ~ N(0, P0),
//
// for which least squares is a tridiagonal system.
namespace proofmass::thesis::errata_smoother_test {
namespace {

using estimate::Mat;
using Series = std::vector<double>;

constexpr double q = 0.3, R = 1.0, P0 = 2.0;
const Series readings{0.4, 1.9, 0.7, -0.3, 1.2, 2.8, 2.1, 1.4, 3.0, 0.9, -0.6, 0.2};
const std::size_t last = readings.size() - 1;

struct Estimate {
  Series mean, variance;
};

estimate::LinearRun<1, 1> smoothed_by_the_library(double F, const Series& z, bool diffuse = false) {
  estimate::LinearModel<1, 1, 1> model;
  model.F(0, 0) = F;
  model.Q(0, 0) = q;
  model.H(0, 0) = 1.0;
  model.R(0) = R;
  std::vector<estimate::Epoch<1, 1>> epochs;
  for (const double value : z) epochs.push_back({.dt_s = 1.0, .z = Mat<1>(value)});
  const std::vector models(z.size(), model);
  estimate::Gaussian<1> prior;
  prior.cov(0, 0) = P0;
  return estimate::smooth_linear(
      estimate::LinearSeries<1, 1, 1>::make(epochs, models).value(),
      diffuse ? estimate::Start<1>::diffuse() : estimate::Start<1>(prior));
}

/// Minimises x[0]²/P0 + Σ (x[k] − F x[k−1])²/q + Σ (z[k] − x[k])²/R by elimination, and inverts its
/// matrix column by column.
Estimate least_squares(double F, const Series& z) {
  const std::size_t n = z.size();
  Series diagonal(n, 1.0 / R + 1.0 / q + F * F / q);
  diagonal.front() = 1.0 / R + 1.0 / P0 + F * F / q;
  diagonal.back() -= F * F / q;
  const double beside = -F / q;
  const auto solve = [&](Series right) {
    Series pivot = diagonal;
    for (std::size_t k = 1; k < n; ++k) {
      pivot[k] -= beside * beside / pivot[k - 1];
      right[k] -= beside / pivot[k - 1] * right[k - 1];
    }
    for (std::size_t k = n; k-- > 0;) {
      if (k + 1 < n) right[k] -= beside * right[k + 1];
      right[k] /= pivot[k];
    }
    return right;
  };
  Series right(n);
  std::ranges::transform(z, right.begin(), [](double value) { return value / R; });
  Estimate out{.mean = solve(right), .variance = {}};
  for (std::size_t k = 0; k < n; ++k) {
    Series unit(n, 0.0);
    unit[k] = 1.0;
    out.variance.push_back(solve(unit)[k]);
  }
  return out;
}

/// Readings of the equations of the backward pass.
struct Form {
  bool transposed = false;  ///< (4.36): (P⁻)ᵀ for the inverse
  bool minus = false;       ///< (4.38): P⁺ + G (P⁻ − Pˢ) Gᵀ
  bool twice = false;       ///< (4.39): G (xˢ − x⁻) Gᵀ
};

/// (4.34) to (4.39) applied to the library's filter.
Estimate way_back(double F, const Series& z, const Form& form) {
  const auto run = smoothed_by_the_library(F, z);
  const auto& end = run.steps.back().filtered;
  Estimate out{.mean = Series(z.size(), end.mean(0)), .variance = Series(z.size(), end.cov(0, 0))};
  for (std::size_t k = z.size() - 1; k-- > 0;) {
    const auto& x = run.steps[k].filtered;
    const double P = x.cov(0, 0), predicted = F * P * F + q;
    const double gain = P * F * (form.transposed ? predicted : 1.0 / predicted);
    const double moved = out.mean[k + 1] - F * x.mean(0);
    const double gained = out.variance[k + 1] - predicted;
    out.mean[k] = x.mean(0) + gain * moved * (form.twice ? gain : 1.0);
    out.variance[k] = P + gain * (form.minus ? -gained : gained) * gain;
  }
  return out;
}

double apart(const Series& a, const Series& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

TEST(ErrataChapter4, TheSmootherPutRightIsLeastSquaresAndTheLibrarys) {
  const Estimate truth = least_squares(0.9, readings), ours = way_back(0.9, readings, {});
  EXPECT_LT(apart(ours.mean, truth.mean), 1e-13);
  EXPECT_LT(apart(ours.variance, truth.variance), 1e-13);
  const auto run = smoothed_by_the_library(0.9, readings);
  for (std::size_t k = 0; k <= last; ++k) {
    EXPECT_NEAR(run.steps[k].smoothed.mean(0), truth.mean[k], 1e-13);
    EXPECT_NEAR(run.steps[k].smoothed.cov(0, 0), truth.variance[k], 1e-13);
  }
}

// (4.36): I⁻ = (P⁻)ᵀ.
TEST(ErrataChapter4, TheSmoothersGainTakesTheInverseAndNotTheTranspose) {
  const Estimate truth = least_squares(0.9, readings);
  const Estimate printed = way_back(0.9, readings, {.transposed = true});
  EXPECT_GT(apart(printed.mean, truth.mean), 0.1);
  EXPECT_GT(apart(printed.variance, truth.variance), 0.1);
}

// (4.38): P⁺ + K (P⁻ − Pˢ) Kᵀ.
TEST(ErrataChapter4, WithThePrintedSignTheSmootherIsLessSureThanTheFilter) {
  const auto run = smoothed_by_the_library(0.9, readings);
  const Estimate printed = way_back(0.9, readings, {.minus = true});
  for (std::size_t k = 0; k < last; ++k) {
    EXPECT_LT(run.steps[k].smoothed.cov(0, 0), run.steps[k].filtered.cov(0, 0));
    EXPECT_GT(printed.variance[k], run.steps[k].filtered.cov(0, 0));
  }
}

// (4.39): x⁺ + K (xˢ − x⁻) Kᵀ.
TEST(ErrataChapter4, WithTheGainTwiceTheSmootherIsNotLeastSquares) {
  const Estimate printed = way_back(0.9, readings, {.twice = true});
  EXPECT_GT(apart(printed.mean, least_squares(0.9, readings).mean), 0.1);
}

// (4.29): "P⁻ is the covariance vector's updated value and P⁺ is the predicted value".
TEST(ErrataChapter4, WhatTheReadingHasUpdatedIsTheSmallerCovariance) {
  const auto run = smoothed_by_the_library(0.9, readings);
  for (const auto& step : run.steps)
    EXPECT_LT(step.filtered.cov(0, 0), step.innovation_variance(0) - R);  // P⁻ = S − R
}

// 5.7: "by running the Kalman filter in backward direction"; 4.1.5: "two filter configuration".
TEST(ErrataChapter4, AFilterRunBackwardIsHalfOfTheSmoother) {
  const auto forward = smoothed_by_the_library(1.0, readings, true);
  const auto backward =
      smoothed_by_the_library(1.0, Series(readings.rbegin(), readings.rend()), true);
  for (std::size_t k = 0; k < last; ++k) {
    const auto& ahead = forward.steps[k].filtered;              // measurements up to k
    const auto& behind = backward.steps[last - k].filtered;     // measurements from k on
    const auto& later = backward.steps[last - k - 1].filtered;  // measurements from k + 1 on
    const double weight = 1.0 / ahead.cov(0, 0), other = 1.0 / (later.cov(0, 0) + q);
    const auto& both = forward.steps[k].smoothed;
    EXPECT_NEAR(both.cov(0, 0), 1.0 / (weight + other), 1e-12);
    EXPECT_NEAR(both.mean(0), (weight * ahead.mean(0) + other * later.mean(0)) / (weight + other),
                1e-12);
    if (k > 0) {
      EXPECT_GT(behind.cov(0, 0), 1.1 * both.cov(0, 0));
    }
  }
}

// 6.1, 6.2: improvement by smoothing, and use of the smoothed output as feedback to the motor.
TEST(ErrataChapter6, AtTheLastEpochTheSmootherIsTheFilter) {
  const auto run = smoothed_by_the_library(0.9, readings);
  EXPECT_EQ(run.steps.back().smoothed.mean, run.steps.back().filtered.mean);
  EXPECT_EQ(run.steps.back().smoothed.cov, run.steps.back().filtered.cov);
  EXPECT_LT(run.steps[last / 2].smoothed.cov(0, 0), 0.9 * run.steps[last / 2].filtered.cov(0, 0));
}

}  // namespace
}  // namespace proofmass::thesis::errata_smoother_test
