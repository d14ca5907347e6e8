#include "proofmass/estimate/lag_advice.hpp"

#include <gtest/gtest.h>

#include "proofmass/estimate/filter/fixed_lag.hpp"
#include "proofmass/estimate/filter/lag_test_support.hpp"

namespace proofmass::estimate::lag_advice_test {
namespace {

const LinearModel<3, 2, 1> oscillator = test::driven_oscillator(0.1);

// The motion of a carried accelerometer with position measured in addition to acceleration.
LinearModel<4, 2> fixed_motion() {
  const auto one = test::biased_motion(0.005);
  LinearModel<4, 2> m;
  m.F = one.F;
  m.Q = one.Q;
  m.H << one.H, 1.0, 0.0, 0.0, 0.0;
  m.R << one.R, 1e-4;
  return m;
}

template <int N, int M, int U>
LinearSeries<N, M, U> even_series(const LinearModel<N, M, U>& model, std::size_t count) {
  Random random(3, "even series");
  std::vector<Epoch<M, U>> epochs(count);
  for (auto& epoch : epochs) {
    for (int i = 0; i < M; ++i) epoch.z(i) = random.normal();
    if constexpr (U > 0) epoch.u.setConstant(random.uniform());
  }
  return LinearSeries<N, M, U>::make(epochs, [&](double) { return model; }).value();
}

template <int N>
FilterState<N> wide() {
  FilterState<N> state;
  state.x.cov.diagonal().setConstant(10.0);
  return state;
}

TEST(LagGain, IsWhatTheFixedLagSmoothersCovarianceFallsBy) {
  const auto steady = steady_state(oscillator).value();
  const LagGain gain(oscillator, steady);
  FixedLag<3> window(30);
  FilterState<3> state = wide<3>();
  const auto series = even_series(oscillator, 2000);
  filter(series, {0, 2000}, {}, state, [&](std::size_t, const auto& step) { window.push(step); });
  for (std::size_t lag = 0; lag <= 30; ++lag) {
    const Mat<3> fallen = window.state(0).cov.diagonal() - window.state(lag).cov.diagonal();
    EXPECT_LT((Mat<3>(gain.variance_reduction(lag)) - fallen).cwiseAbs().maxCoeff(), 1e-13) << lag;
  }
}

TEST(LagGain, OfAnEndlessLagIsTheFixedIntervalSmoothers) {
  const auto steady = steady_state(oscillator).value();
  const LagGain gain(oscillator, steady);
  const Mat<3> endless = gain.variance_reduction();
  EXPECT_TRUE(endless.isApprox(steady.filtered.diagonal() - steady.smoothed.diagonal(), 1e-12));
  EXPECT_TRUE(endless.isApprox(gain.variance_reduction(1U << 20U), 1e-13));
  EXPECT_TRUE(endless.isApprox(gain.variance_reduction(~std::size_t{0}), 1e-13));
}

// In rotated axes rounding couples the observable states with the unbounded variance of the
// position.
TEST(LagGain, HoldsWhereNoAxisIsWhollyUnseen) {
  const auto model = test::biased_motion(0.005);
  Mat<4, 4> T;
  const double c = std::cos(0.7), s = std::sin(0.7);
  T << c, 0, s, 0, 0, c, 0, s, -s, 0, c, 0, 0, -s, 0, c;
  LinearModel<4, 1> turned = model;
  turned.F = T * model.F * T.transpose();
  turned.Q = T * model.Q * T.transpose();
  turned.H = model.H * T.transpose();
  const auto steady = steady_state(model).value();
  const std::size_t lag = 40000;
  const Mat<4, 4> A = model.F * (Mat<4, 4>::Identity() - steady.gain * model.H);
  Mat<4, 4> sum = Mat<4, 4>::Zero();
  Mat<1, 4> row = model.H;
  for (std::size_t i = 0; i < lag; ++i, row = (row * A).eval())
    sum += row.transpose() * row / steady.innovation_variance(0);
  const Mat<4, 4> G = T * steady.seen * model.F.transpose();
  const Mat<4> expected = (G * sum * G.transpose()).diagonal();
  const LagGain gain(turned, steady_state(turned).value());
  EXPECT_LT(((Mat<4>(gain.variance_reduction(lag)) - expected).array() / expected.array())
                .abs()
                .maxCoeff(),
            1e-6);
}

TEST(LagGain, TheShortestLagIsEnoughAndOneLessIsNot) {
  const auto model = fixed_motion();
  const auto steady = steady_state(model).value();
  const LagGain gain(model, steady);
  for (int state = 0; state < 4; ++state)
    for (const double share : {0.01, 0.5, 0.95, 0.99, 0.999}) {
      const std::size_t lag = gain.shortest(state, share);
      const double wanted = share * gain.variance_reduction()(state);
      EXPECT_GE(gain.variance_reduction(lag)(state), wanted * (1.0 - 1e-12)) << state << share;
      EXPECT_LT(gain.variance_reduction(lag - 1)(state), wanted * (1.0 + 1e-12)) << state << share;
    }
}

// Information of an accelerometer on its own bias accumulates over the bias's time constant; it has
// none on position and velocity.
TEST(LagAdvice, HasNoneForWhatTheReadingsDoNotShow) {
  const auto model = test::biased_motion(0.005);
  const auto advice = advise_lag(model, steady_state(model).value());
  ASSERT_EQ(advice.size(), 4U);
  for (const int unseen : {0, 1}) {
    const auto& none = advice[static_cast<std::size_t>(unseen)];
    EXPECT_FALSE(none.lag);
    EXPECT_EQ(lag_words(none, "position", 0.005),
              "position: no lag pays: not observable: its variance grows without limit at any "
              "lag");
  }
  ASSERT_TRUE(advice[3].lag);
  EXPECT_GT(advice[3].lag->lag_95, 100U);
}

// A slowly drifting level: P⁺ and P[k|∞] of the local level are known in closed form, and each
// additional measurement removes the same fraction, (1 − K)², of the remainder.
TEST(LagAdvice, OfALocalLevelIsTheClosedForm) {
  LinearModel<1, 1> level;
  level.F << 1.0;
  level.H << 1.0;
  level.Q << 0.3;
  level.R << 2.0;
  const double P = 0.5 * (0.3 + std::sqrt(0.3 * 0.3 + 4.0 * 0.3 * 2.0)), K = P / (P + 2.0);
  const auto advice = advise_lag(level, steady_state(level).value());
  ASSERT_TRUE(advice[0].lag);
  EXPECT_NEAR(advice[0].lag->filter_variance, K * 2.0, 1e-12);
  const double all = K * K * 4.0 / (P + 2.0) / (1.0 - (1.0 - K) * (1.0 - K));
  EXPECT_NEAR(advice[0].lag->interval_variance, K * 2.0 - all, 1e-12);
  const auto lag_of = [&](double share) {
    return static_cast<std::size_t>(std::ceil(std::log(1.0 - share) / (2.0 * std::log(1.0 - K))));
  };
  EXPECT_EQ(advice[0].lag->lag_95, lag_of(0.95));
  EXPECT_EQ(advice[0].lag->lag_99, lag_of(0.99));
  EXPECT_EQ(lag_words(advice[0], "level", 0.5),
            "level: a lag of 4 readings (2 s) gets 95 %, of 6 readings (3 s) 99 % of what all "
            "later readings give; its standard deviation then falls by 23 %");
}

// A white state that is measured at every epoch: later measurements contain no information on it.
TEST(LagAdvice, HasNoneIfLaterMeasurementsAreUninformative) {
  LinearModel<1, 1> forgetful;
  forgetful.F << 0.0;
  forgetful.H << 1.0;
  forgetful.Q << 1.0;
  forgetful.R << 1.0;
  const auto advice = advise_lag(forgetful, steady_state(forgetful).value());
  EXPECT_FALSE(advice[0].lag);
  EXPECT_EQ(advice[0].why_not, "later measurements contain no further information on it");
}

}  // namespace
}  // namespace proofmass::estimate::lag_advice_test
