#include "proofmass/estimate/filter/fixed_lag.hpp"

#include <gtest/gtest.h>

#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/filter/lag_test_support.hpp"
#include "proofmass/estimate/filter/linear_gaussian.hpp"

namespace proofmass::estimate::fixed_lag_test {
namespace {

using test::distance;

// Fixed-interval estimates of all epochs given the measurements before `count`.
std::vector<Gaussian<3>> whole_interval(std::size_t count, const Gate& gate) {
  auto series = test::uneven_series(count);
  series.set_reopened(test::oscillator_prior().cov);
  std::vector<Gaussian<3>> out(count);
  smooth(
      series, FilterState<3>{test::oscillator_prior()}, gate, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const BackwardInformation<3>& later) {
        out[k] = {later.mean(step.filtered), later.cov<3>(step.filtered)};
      });
  return out;
}

void expect_equal(const Gaussian<3>& x, const Gaussian<3>& expected) {
  EXPECT_LT(distance<3>(x.mean, expected), 1e-12);
  EXPECT_LT(distance<3>(x.cov, expected.cov), 1e-12);
  EXPECT_EQ(x.cov, x.cov.transpose());
}

TEST(FixedLag, EveryStateInTheWindowIsTheFixedIntervalSmoothersOfTheReadingsSoFar) {
  const std::size_t count = 60, lag = 8;
  for (const Gate& gate : {Gate{}, Gate{.huber = 2.0, .limit = 6.0, .patience = 25}}) {
    auto series = test::uneven_series(count);
    series.set_reopened(test::oscillator_prior().cov);
    FixedLag<3> window(lag);
    FilterState<3> state{test::oscillator_prior()};
    filter(series, {0, count}, gate, state, [&](std::size_t k, const auto& step) {
      SCOPED_TRACE(k);
      window.push(step);
      const auto expected = whole_interval(k + 1, gate);
      ASSERT_EQ(window.size(), std::min(k, lag) + 1);
      for (std::size_t ago = 0; ago < window.size(); ++ago)
        expect_equal(window.state(ago), expected[k - ago]);
    });
  }
}

TEST(FixedLag, ARunGivesEachEpochOnceWithTheLastOnesGivenEverything) {
  const std::size_t count = 40;
  const auto series = test::uneven_series(count);
  const FilterState<3> prior{test::oscillator_prior()};
  for (const std::size_t lag : {0U, 1U, 7U, 39U, 40U, 1000U}) {
    SCOPED_TRACE(lag);
    std::size_t next = 0;
    smooth_fixed_lag(series, prior, {}, lag, [&](std::size_t k, const Gaussian<3>& x) {
      EXPECT_EQ(k, next++);
      expect_equal(x, whole_interval(std::min(k + lag + 1, count), {})[k]);
    });
    EXPECT_EQ(next, count);
  }
}

TEST(FixedLag, ThatHoldsAStatesFirstEntriesHasThemOfTheWholeOne) {
  FixedLag<3> whole(6);
  FixedLag<3, 2> first(6);
  FilterState<3> state{test::oscillator_prior()};
  filter(test::uneven_series(50), {0, 50}, Gate{}, state, [&](std::size_t k, const auto& step) {
    whole.push(step);
    first.push(step);
    const std::size_t ago = std::min<std::size_t>(k, 6);
    const Gaussian<3>& x = whole.state(ago);
    EXPECT_LT((first.state(ago).mean - x.mean.head<2>()).norm(), 1e-12);
    const Mat<2, 2> cov = x.cov.topLeftCorner<2, 2>();
    EXPECT_LT((first.state(ago).cov - cov).norm(), 1e-12);
  });
}

TEST(FixedLag, OfNothingIsNothing) {
  smooth_fixed_lag(test::uneven_series(0), FilterState<3>{test::oscillator_prior()}, {}, 5,
                   [](std::size_t, const auto&) { FAIL(); });
}

TEST(FixedLag, AStepAllocatesNothing) {
  const auto series = test::uneven_series(100);
  FixedLag<3> window(10);
  FilterState<3> state{test::oscillator_prior()};
  Step<3, 3, 2> step;
  const std::size_t before = test::allocations();
  for (std::size_t k = 0; k < series.size(); ++k) {
    advance(series, k, {}, state, step);
    window.push(step);
  }
  EXPECT_EQ(test::allocations(), before);
}

TEST(FixedPoint, IsTheFixedIntervalSmootherAtThePointsAskedFor) {
  const auto series = test::uneven_series(200);
  const auto expected = whole_interval(200, {});
  const std::vector<std::size_t> points{150, 0, 199, 37, 37};
  const auto smoothed = smooth_points(series, FilterState<3>{test::oscillator_prior()}, {}, points);
  ASSERT_EQ(smoothed.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) expect_equal(smoothed[i], expected[points[i]]);
}

// A dynamic position and velocity, followed by a static gain and offset.
struct Gauge {
  static constexpr int states = 4, moving = 2, channels = 2;
  [[nodiscard]] std::size_t size() const { return 90; }
  [[nodiscard]] Transition<4, 2> transition(const Mat<4>& x, std::size_t k) const {
    const double t = k % 7 == 0 ? 0.3 : 0.1;
    Transition<4, 2> step;
    step.F << 1, t, 0, 1;
    step.Q << t * t * t / 3, t * t / 2, t * t / 2, t;
    step.mean = step.F * x.head<2>();
    step.walk << 99, 99, 0.0, 1e-4 * t;
    return step;
  }
  void measure(const Mat<4>& x, std::size_t k, Readings<4, 2>& out) const {
    const double t = 0.1 * static_cast<double>(k);
    out.count = k % 5 == 3 ? 1 : 2;
    out.rows[0] = {std::sin(t), (1.0 + x(2)) * x(0) + x(3), 0.01,
                   Mat<4>(1.0 + x(2), 0.0, x(0), 1.0)};
    out.rows[1] = {std::cos(t), x(1), 0.09, Mat<4>(0, 1, 0, 0)};
  }
  void reopen(Gaussian<4>&, std::size_t) const {}
};

TEST(FixedPoint, IsTheExtendedSmootherOfAModelThatIsNotLinear) {
  FilterState<4> prior;
  prior.x.cov.diagonal() << 1.0, 1.0, 0.01, 0.04;
  std::vector<std::size_t> points(Gauge{}.size());
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = k;
  const auto smoothed = smooth_points(Gauge{}, prior, {}, points);
  smooth(
      Gauge{}, prior, {}, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const BackwardInformation<4>& later) {
        const Gaussian<4> expected{later.mean(step.filtered), later.cov<4>(step.filtered)};
        EXPECT_LT(distance<4>(smoothed[k].mean, expected), 1e-12) << "k = " << k;
        EXPECT_LT(distance<4>(smoothed[k].cov, expected.cov), 1e-12) << "k = " << k;
      });
}

}  // namespace
}  // namespace proofmass::estimate::fixed_lag_test
