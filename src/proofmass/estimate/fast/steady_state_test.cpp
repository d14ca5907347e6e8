#include "proofmass/estimate/fast/steady_state.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate::steady_state_test {
namespace {

LinearModel<4, 1> with_bias_model(double time_constant_s = 100.0, double dt_s = 0.005) {
  const auto m = pva_bias_model({.motion = {dt_s, 1.0, 0.02 * 0.02},
                                 .time_constant_s = time_constant_s,
                                 .bias_psd_m2ps5 = 2.0 * 0.05 * 0.05 / time_constant_s});
  return {m.F, m.Q, m.H, m.R};
}
LinearModel<4, 1> position_read(LinearModel<4, 1> m) {
  m.H << 1.0, 0.0, 0.0, 0.0;
  return m;
}

/// Runs the filter itself until convergence.
template <int N, int M>
struct Recursion {
  Mat<N, N> predicted, filtered;
  Mat<N, M> gain;
};
template <int N, int M>
Recursion<N, M> recursion(const LinearModel<N, M>& m, int steps) {
  Recursion<N, M> r;
  r.filtered = 0.01 * Mat<N, N>::Identity();
  for (int k = 0; k < steps; ++k) {
    const Mat<N, N> next = m.F * r.filtered * m.F.transpose() + m.Q;
    r.filtered = r.predicted = 0.5 * (next + next.transpose());
    for (int i = 0; i < M; ++i) {
      const Mat<N> Ph = r.filtered * m.H.row(i).transpose();
      r.filtered -= Ph * Ph.transpose() / (m.H.row(i).dot(Ph) + m.R(i));
    }
  }
  r.gain = r.filtered * m.H.transpose() * m.R.cwiseInverse().asDiagonal();
  return r;
}

TEST(SteadyState, OfALocalLevelIsTheRootOfItsQuadratic) {
  const double q = 0.3, r = 2.0;
  LinearModel<1, 1> m;
  m.F << 1.0;
  m.Q << q;
  m.H << 1.0;
  m.R << r;
  const auto s = steady_state(m).value();
  const double P = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
  EXPECT_NEAR(s.predicted_variance(0).value(), P, 1e-14);
  EXPECT_NEAR(s.gain(0), P / (P + r), 1e-15);
  EXPECT_NEAR(s.innovation_variance(0), P + r, 1e-14);
  EXPECT_NEAR(s.slowest_steps, -1.0 / std::log(r / (P + r)), 1e-9);
  // Smoothed: 1 / P[k|N] is the sum of the information from both directions, minus that of the
  // level without measurements.
  EXPECT_NEAR(s.smoothed_variance(0).value(),
              P * r / (P + r) - std::pow(P * r / (P + r), 2) * s.Lambda(0, 0), 1e-14);
  EXPECT_NEAR(s.smoothed_variance(0).value(), q * r / std::sqrt(q * q + 4.0 * q * r), 1e-14);
}

// Error of a test for small changes of P: 5.4 % in the variance of this bias.
TEST(SteadyState, OfAnUnobservableBiasIsItsStationaryVariance) {
  for (const double time_constant_s : {1.0, 100.0, 1e4}) {
    const auto s = steady_state(position_read(with_bias_model(time_constant_s))).value();
    EXPECT_TRUE(s.all_have_limits);
    EXPECT_NEAR(s.filtered_variance(3).value() / (0.05 * 0.05), 1.0, 1e-9);
    EXPECT_EQ(s.gain(3), 0.0);
    EXPECT_NEAR(s.slowest_steps, 44.9, 0.1) << "of what is read; the bias is not";
  }
}

TEST(SteadyState, OfPositionReadIsWhereTheFilterGoes) {
  const auto m = position_read(with_bias_model(0.1));
  const auto s = steady_state(m).value();
  const auto r = recursion(m, 20'000);
  EXPECT_TRUE(s.gain.isApprox(r.gain, 1e-12));
  EXPECT_TRUE(s.predicted.dense().isApprox(r.predicted, 1e-12));
  EXPECT_TRUE(s.filtered.dense().isApprox(r.filtered, 1e-12));
  EXPECT_TRUE(s.seen.leftCols<3>().isApprox(r.filtered.leftCols<3>(), 1e-12));
}

TEST(SteadyState, OfAccelerationReadHasGainsForAllAndVariancesForSome) {
  const auto m = with_bias_model(1.0);
  const auto s = steady_state(m).value();
  EXPECT_EQ(s.has_limit, (std::array{false, false, true, true}));
  EXPECT_FALSE(s.filtered_variance(0).has_value());
  EXPECT_FALSE(s.smoothed_variance(1).has_value());
  EXPECT_EQ(s.predicted(0, 0), 0.0);
  const auto r = recursion(m, 40'000);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s.gain(i) / r.gain(i), 1.0, 1e-9) << "state " << i;
  for (int i = 2; i < 4; ++i)
    EXPECT_NEAR(s.filtered_variance(i).value() / r.filtered(i, i), 1.0, 1e-10);
  // λ is 0 for position and velocity, so only the other columns count.
  EXPECT_TRUE(s.seen.rightCols<2>().isApprox(r.filtered.rightCols<2>(), 1e-9));
}

TEST(SteadyState, OfASlowBiasIsReachedByDoublingThoughTheFilterTakesAnHour) {
  const auto s = steady_state(with_bias_model(100.0)).value();
  EXPECT_NEAR(s.slowest_steps, 20000.5, 0.1);
  const auto r = recursion(with_bias_model(100.0), 800'000);
  EXPECT_NEAR(s.filtered_variance(3).value() / r.filtered(3, 3), 1.0, 1e-10);
}

TEST(SteadyState, SmootherIsTheOneFarFromBothEnds) {
  const auto m = position_read(with_bias_model(0.1));
  const auto s = steady_state(m).value();
  std::vector<Epoch<1>> epochs(4000, Epoch<1>{0.005, Mat<1>(0.0)});
  const auto series = LinearSeries<4, 1>::make(epochs, [&](double) { return m; }).value();
  Gaussian<4> prior;
  prior.cov.setIdentity();
  const auto run = smooth_linear(series, prior);
  EXPECT_TRUE(s.smoothed.dense().isApprox(run.steps[2000].smoothed.cov.dense(), 1e-9));
}

// Only the sum of two random walks is measured: each variance grows, that of the sum does not.
TEST(SteadyState, DistinguishesAnUnboundedDirectionFromAState) {
  LinearModel<3, 1> m;
  m.F.setIdentity();
  m.F(2, 2) = 0.9;
  m.Q = Mat<3>(0.2, 0.5, 0.1).asDiagonal();
  m.H << 1.0, 1.0, 0.0;
  m.R << 1.0;
  const auto s = steady_state(m).value();
  EXPECT_EQ(s.has_limit, (std::array{false, false, true}));
  EXPECT_NEAR(s.filtered_variance(2).value(), 0.1 / (1.0 - 0.81), 1e-12);
  const auto r = recursion(m, 2'000);
  EXPECT_TRUE(s.gain.head<2>().isApprox(r.gain.head<2>(), 1e-9));
  EXPECT_NEAR(s.seen.row(0).dot(Mat<3>(1.0, 1.0, 0.0)), r.filtered(0, 0) + r.filtered(0, 1), 1e-9);
}

TEST(SteadyState, TakesSeveralChannels) {
  const auto one = with_bias_model(1.0);
  LinearModel<4, 2> m;
  m.F = one.F;
  m.Q = one.Q;
  m.H << 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0;
  m.R << 4e-4, 1e-2;
  const auto s = steady_state(m).value();
  EXPECT_TRUE(s.all_have_limits);
  const auto r = recursion(m, 20'000);
  EXPECT_TRUE(s.gain.isApprox(r.gain, 1e-10));
  EXPECT_TRUE(s.filtered.dense().isApprox(r.filtered, 1e-10));
}

TEST(SteadyState, DoesNotDependOnTheUnitsOfTheStates) {
  const auto m = with_bias_model(1.0, 1e-5);
  const auto s = steady_state(m).value();
  const Mat<4> units(1e9, 1e6, 1e3, 1e-4);
  LinearModel<4, 1> scaled = m;
  scaled.F = units.asDiagonal() * m.F * units.cwiseInverse().asDiagonal();
  scaled.Q = units.asDiagonal() * m.Q * units.asDiagonal();
  scaled.H = m.H * units.cwiseInverse().asDiagonal();
  const auto t = steady_state(scaled).value();
  EXPECT_EQ(s.has_limit, t.has_limit);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(t.gain(i) / (units(i) * s.gain(i)), 1.0, 1e-9);
}

TEST(SteadyState, WithoutMeasurementsIsTheModelItself) {
  auto m = with_bias_model(1.0);
  m.H.setZero();
  const auto s = steady_state(m).value();
  EXPECT_EQ(s.has_limit, (std::array{false, false, false, true}));
  EXPECT_EQ(s.gain, (Mat<4, 1>::Zero()));
  EXPECT_NEAR(s.smoothed_variance(3).value(), 0.05 * 0.05, 1e-14);
}

TEST(SteadyState, SaysWhereEvenTheGainsHaveNoLimit) {
  LinearModel<1, 1> constant;
  constant.F << 1.0;
  constant.Q << 0.0;
  constant.H << 1.0;
  constant.R << 1.0;
  const auto known_ever_better = steady_state(constant);
  ASSERT_FALSE(known_ever_better.has_value());
  EXPECT_EQ(known_ever_better.error().code, Errc::not_observable);

  LinearModel<2, 1> exploding;
  exploding.F << 0.9, 0.0, 0.1, 2.0;
  exploding.Q.setIdentity();
  exploding.H << 1.0, 0.0;
  exploding.R << 1.0;
  EXPECT_TRUE(steady_state(exploding).has_value()) << "2 times what is left of an error, 0.4";
  exploding.R << 1e4;
  exploding.Q *= 1e-4;
  EXPECT_FALSE(steady_state(exploding).has_value());
}

TEST(SteadyState, RefusesInvalidModels) {
  auto m = with_bias_model();
  m.R(0) = -1.0;
  EXPECT_EQ(steady_state(m).error().code, Errc::not_positive_definite);
  m = with_bias_model();
  m.F(1, 2) = std::nan("");
  EXPECT_EQ(steady_state(m).error().code, Errc::not_finite);
}

}  // namespace
}  // namespace proofmass::estimate::steady_state_test
