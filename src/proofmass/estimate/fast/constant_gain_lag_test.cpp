#include "proofmass/estimate/fast/constant_gain_lag.hpp"

#include <gtest/gtest.h>

#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/filter/fixed_lag.hpp"
#include "proofmass/estimate/filter/lag_test_support.hpp"
#include "proofmass/estimate/lag_advice.hpp"

namespace proofmass::estimate::constant_gain_lag_test {
namespace {

const LinearModel<3, 2, 1> oscillator = test::driven_oscillator(0.1);

TEST(ConstantGainLag, HasTheTapsOfTheRiccatiLimit) {
  const auto steady = steady_state(oscillator).value();
  const ConstantGainLag<3, 2, 1> smoother(oscillator, steady, 6, Mat<3>::Zero());
  const Mat<3, 3> A = oscillator.F * (Mat<3, 3>::Identity() - steady.gain * oscillator.H);
  Mat<3, 3> power = Mat<3, 3>::Identity();
  for (std::size_t i = 1; i <= 6; ++i) {
    power = (power * A.transpose()).eval();
    const Mat<3, 2> expected = steady.predicted.dense() * power * oscillator.H.transpose() *
                               positive_inverse(steady.innovation_variance);
    EXPECT_TRUE(smoother.tap(i).isApprox(expected, 1e-12)) << "i = " << i;
  }
}

/// Largest difference of the constant-gain form from the time-varying one, in standard deviations
/// of the latter, from epoch `from` on.
template <int N, int M, int U>
double apart(const LinearModel<N, M, U>& model,
             const Gaussian<N>& start,
             std::size_t from,
             std::size_t count,
             std::size_t lag) {
  Random random(3, "constant gain");
  std::vector<Epoch<M, U>> epochs(count);
  for (auto& epoch : epochs) {
    for (int i = 0; i < M; ++i) epoch.z(i) = random.normal();
    if constexpr (U > 0) epoch.u.setConstant(random.uniform());
  }
  std::vector<Gaussian<N>> varying;
  smooth_fixed_lag(LinearSeries<N, M, U>::make(epochs, [&](double) { return model; }).value(),
                   FilterState<N>{start}, {}, lag,
                   [&](std::size_t, const Gaussian<N>& x) { varying.push_back(x); });
  ConstantGainLag<N, M, U> constant(model, steady_state(model).value(), lag, start.mean);
  double farthest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_TRUE(constant.step(epochs[k].z, epochs[k].u));
    EXPECT_EQ(constant.lagged().has_value(), k >= lag);
    if (k < from + lag) continue;
    farthest = std::max(farthest, test::distance<N>(*constant.lagged(), varying[k - lag]));
  }
  return farthest;
}

TEST(ConstantGainLag, FromTheRiccatiLimitOnIsTheTimeVaryingOne) {
  const auto steady = steady_state(oscillator).value();
  const Gaussian<3> start{Mat<3>(0.3, -0.4, 0.5), steady.predicted.dense()};
  for (const std::size_t lag : {0U, 1U, 12U})
    EXPECT_LT(apart(oscillator, start, 0, 400, lag), 1e-12) << "lag = " << lag;
}

TEST(ConstantGainLag, FromAnyStartComesToTheTimeVaryingOne) {
  EXPECT_LT(apart(oscillator, test::oscillator_prior(), 600, 900, 9), 1e-12);
}

// With acceleration measurements only, position and velocity are not observable and their variances
// grow, but their gains have a limit.
TEST(ConstantGainLag, HasGainsForStatesWhoseVarianceHasNoLimit) {
  const auto biased = test::biased_motion(0.05);
  const LinearModel<3, 1> model{biased.F.topLeftCorner<3, 3>(), biased.Q.topLeftCorner<3, 3>(),
                                biased.H.head<3>(), Mat<1>(0.01)};
  const auto steady = steady_state(model).value();
  ASSERT_FALSE(steady.has_limit[0]);
  ASSERT_TRUE(steady.has_limit[2]);
  Gaussian<3> start;
  start.cov = steady.predicted.dense() + 1e-4 * Mat<3, 3>::Identity();
  const std::size_t lag = 20;
  Random random(5, "accelerations");
  std::vector<Epoch<1>> epochs(400);
  for (auto& epoch : epochs) epoch.z << random.normal();
  std::vector<Gaussian<3>> varying, filtered;
  const auto series = LinearSeries<3, 1>::make(epochs, [&](double) { return model; }).value();
  const auto keep = [](std::vector<Gaussian<3>>& in) {
    return [&](std::size_t, const Gaussian<3>& x) { in.push_back(x); };
  };
  smooth_fixed_lag(series, FilterState<3>{start}, {}, lag, keep(varying));
  smooth_fixed_lag(series, FilterState<3>{start}, {}, 0, keep(filtered));
  ConstantGainLag<3, 1> constant(model, steady, lag, start.mean);
  std::vector<Mat<3>> past;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    ASSERT_TRUE(constant.step(epochs[k].z));
    past.push_back(constant.filtered());
    if (k < 200 + lag) continue;
    // Effect of the later measurements; the two filters differ by their initial states.
    const Mat<3> added = *constant.lagged() - past[k - lag];
    const Mat<3> expected = varying[k - lag].mean - filtered[k - lag].mean;
    EXPECT_LT((added - expected).cwiseAbs().maxCoeff(), 1e-11) << "k = " << k;
  }
}

// The recursion of a widely used library, which propagates the filtered covariance with (F − K H)ᵀ.
std::vector<double> wrong_taps(const LinearModel<2, 1>& model,
                               const SteadyState<2, 1>& steady,
                               std::size_t lag) {
  std::vector<double> taps;
  Mat<2, 2> carried = steady.filtered.dense();
  for (std::size_t i = 0; i < lag; ++i) {
    taps.push_back((carried * model.H.transpose())(0) / steady.innovation_variance(0));
    carried = (carried * (model.F - steady.gain * model.H).transpose()).eval();
  }
  return taps;
}

// Constant velocity, lag 8, steps of 1 s: the error agrees with the model, is a third smaller than
// that of the recursion with the wrong covariance, and as small as the fixed-interval smoother's.
TEST(ConstantGainLag, ErrsAsTheModelSaysAndLessThanTheWrongRecursion) {
  const auto model = test::constant_velocity(1.0, 0.1, 1.0);
  const auto steady = steady_state(model).value();
  const std::size_t lag = 8, count = 20000;
  ConstantGainLag<2, 1> smoother(model, steady, lag, Mat<2>::Zero());
  const auto wrong = wrong_taps(model, steady, lag);
  Random random(1, "constant velocity");
  Mat<2> truth = Mat<2>::Zero(), predicted = Mat<2>::Zero();
  std::vector<double> positions, wrongly;
  double squares = 0.0, wrong_squares = 0.0, filter_squares = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double acceleration = std::sqrt(0.1) * random.normal();
    if (k > 0) truth = (model.F * truth + Mat<2>(0.5, 1.0) * acceleration).eval();
    const double z = truth(0) + random.normal();
    if (k > 0) predicted = model.F * smoother.filtered();
    ASSERT_TRUE(smoother.step(Mat<1>(z)));
    positions.push_back(truth(0));
    wrongly.push_back(predicted(0));
    for (std::size_t i = 0; i < std::min(lag, k + 1); ++i)
      wrongly[k - i] += wrong[i] * (z - predicted(0));
    if (k < lag) continue;
    squares += std::pow((*smoother.lagged())(0) - positions[k - lag], 2);
    wrong_squares += std::pow(wrongly[k - lag] - positions[k - lag], 2);
    filter_squares += std::pow(smoother.filtered()(0) - truth(0), 2);
  }
  const auto rms = [&](double sum) { return std::sqrt(sum / static_cast<double>(count - lag)); };
  const double expected =
      std::sqrt(steady.filtered(0, 0) - LagGain(model, steady).variance_reduction(lag)(0));
  EXPECT_NEAR(rms(filter_squares), 0.739, 0.02);
  EXPECT_NEAR(std::sqrt(steady.filtered(0, 0)), 0.7391, 5e-5);
  EXPECT_NEAR(expected, 0.4423, 5e-5);
  EXPECT_NEAR(rms(squares), expected, 0.01);
  EXPECT_NEAR(rms(wrong_squares) / rms(squares), 1.50, 0.03);
  EXPECT_NEAR(std::sqrt(steady.smoothed(0, 0)), expected, 0.001);
}

TEST(ConstantGainLag, RefusesAMissingMeasurementAndIsUnchanged) {
  const auto model = test::constant_velocity(1.0, 0.1, 1.0);
  ConstantGainLag<2, 1> smoother(model, steady_state(model).value(), 2, Mat<2>::Zero());
  ASSERT_TRUE(smoother.step(Mat<1>(3.0)));
  const Mat<2> before = smoother.filtered();
  EXPECT_FALSE(smoother.step(Mat<1>(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(smoother.step(Mat<1>(std::numeric_limits<double>::infinity())));
  EXPECT_EQ(smoother.filtered(), before);
  EXPECT_FALSE(smoother.lagged());
}

TEST(ConstantGainLag, AStepAllocatesNothing) {
  const auto model = test::constant_velocity(1.0, 0.1, 1.0);
  ConstantGainLag<2, 1> smoother(model, steady_state(model).value(), 8, Mat<2>::Zero());
  const std::size_t before = test::allocations();
  double sum = 0.0;
  for (int k = 0; k < 100; ++k) {
    if (!smoother.step(Mat<1>(k))) break;
    if (const auto x = smoother.lagged()) sum += (*x)(0);
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace proofmass::estimate::constant_gain_lag_test
