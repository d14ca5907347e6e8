#include "proofmass/estimate/filter/live_filter.hpp"

#include <gtest/gtest.h>

#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/filter/lag_test_support.hpp"
#include "proofmass/estimate/filter/linear_gaussian.hpp"

namespace proofmass::estimate::live_filter_test {
namespace {

using Live = LiveFilter<3, 2, 1>;

// Equal, where NaN equals NaN.
template <int N>
bool same(const Mat<N>& a, const Mat<N>& b) {
  return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

TEST(LiveFilter, GivesTheBatchFiltersNumbersToTheLastBit) {
  const auto epochs = test::uneven_epochs(300);
  for (const Gate& gate : {Gate{}, Gate{.huber = 1.0, .limit = 2.5, .patience = 2}}) {
    const auto run =
        filter_linear(test::uneven_series(300), test::oscillator_prior(), {.gate = gate});
    Live live(test::oscillator_prior(), {.gate = gate, .lag = 4});
    double nis = 0.0;
    for (std::size_t k = 0; k < epochs.size(); ++k) {
      ASSERT_TRUE(live.step(test::driven_oscillator(epochs[k].dt_s), epochs[k]));
      const auto& expected = run.steps[k];
      ASSERT_EQ(live.state().mean, expected.filtered.mean) << "k = " << k;
      ASSERT_EQ(live.state().cov, expected.filtered.cov.dense()) << "k = " << k;
      ASSERT_TRUE(same<2>(live.innovation(), expected.innovation));
      ASSERT_TRUE(same<2>(live.innovation_variance(), expected.innovation_variance));
      ASSERT_EQ(live.nis(), expected.nis);
      ASSERT_EQ(live.readings(), expected.readings);
      nis += live.nis();
    }
    EXPECT_EQ(live.epochs(), 300U);
    EXPECT_EQ(live.log_likelihood(), run.log_likelihood);
    EXPECT_EQ(nis, run.nis);
  }
}

TEST(LiveFilter, ItsLaggedStateIsTheFixedLagSmoothers) {
  const std::size_t lag = 6;
  const auto epochs = test::uneven_epochs(50);
  std::vector<Gaussian<3>> expected;
  smooth_fixed_lag(test::uneven_series(50), FilterState<3>{test::oscillator_prior()}, {}, lag,
                   [&](std::size_t, const Gaussian<3>& x) { expected.push_back(x); });
  Live live(test::oscillator_prior(), {.lag = lag});
  EXPECT_EQ(live.lagged(), nullptr);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    ASSERT_TRUE(live.step(test::driven_oscillator(epochs[k].dt_s), epochs[k]));
    ASSERT_NE(live.lagged(), nullptr);
    if (k < lag) continue;
    EXPECT_EQ(live.lagged()->mean, expected[k - lag].mean);
    EXPECT_EQ(live.lagged()->cov, expected[k - lag].cov);
  }
  EXPECT_EQ(live.window().size(), lag + 1);
}

TEST(LiveFilter, WithoutALagHasNoLaggedState) {
  Live live(test::oscillator_prior());
  ASSERT_TRUE(live.step(test::driven_oscillator(0.1), test::uneven_epochs(1)[0]));
  EXPECT_EQ(live.lagged(), nullptr);
}

TEST(LiveFilter, AStepAllocatesNothing) {
  const auto epochs = test::uneven_epochs(1000);
  Live live(test::oscillator_prior(), {.lag = 10});
  const std::size_t before = test::allocations();
  std::size_t refused = 0;
  for (const auto& epoch : epochs)
    if (!live.step(test::driven_oscillator(epoch.dt_s), epoch)) ++refused;
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(refused, 0U);
}

TEST(LiveFilter, IsUnchangedAfterUnusableInput) {
  const auto model = test::driven_oscillator(0.1);
  Live live(test::oscillator_prior(), {.lag = 3});
  const auto epochs = test::uneven_epochs(5);
  ASSERT_TRUE(live.step(model, epochs[0]));
  const Gaussian<3> before = live.state();

  auto infinite = epochs[1];
  infinite.z(1) = -std::numeric_limits<double>::infinity();
  auto no_input = epochs[1];
  no_input.u(0) = std::numeric_limits<double>::quiet_NaN();
  auto exact = model;
  exact.R(0) = 0.0;
  const Status reading = live.step(model, infinite), input = live.step(model, no_input),
               variance = live.step(exact, epochs[1]);
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().code, Errc::not_finite);
  ASSERT_FALSE(input);
  EXPECT_EQ(input.error().code, Errc::not_finite);
  ASSERT_FALSE(variance);
  EXPECT_EQ(variance.error().code, Errc::not_positive_definite);
  EXPECT_EQ(live.state().mean, before.mean);
  EXPECT_EQ(live.state().cov, before.cov);
  EXPECT_EQ(live.epochs(), 1U);
  EXPECT_EQ(live.window().size(), 1U);
}

TEST(LiveFilter, AnEpochWithoutReadingsIsAPrediction) {
  const auto model = test::driven_oscillator(0.4);
  Live live(test::oscillator_prior());
  ASSERT_TRUE(live.step(model, test::uneven_epochs(1)[0]));
  const Gaussian<3> before = live.state();
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(live.step(model, {0.4, Mat<2>(none, none), Mat<1>(2.0)}));
  EXPECT_TRUE(live.state().mean.isApprox(model.F * before.mean + model.B * 2.0, 1e-15));
  EXPECT_TRUE(
      live.state().cov.isApprox(model.F * before.cov * model.F.transpose() + model.Q, 1e-14));
  EXPECT_EQ(live.readings(), 0);
  EXPECT_EQ(live.nis(), 0.0);
  EXPECT_TRUE(std::isnan(live.innovation()(0)));
}

}  // namespace
}  // namespace proofmass::estimate::live_filter_test
