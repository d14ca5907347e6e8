#include "proofmass/estimate/filter/smoother.hpp"

#include <gtest/gtest.h>

#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/filter/linear_gaussian.hpp"

namespace proofmass::estimate::kalman_test {
namespace {

// Dynamic position and velocity, a static gain and an offset with a random walk: measurements of (1
// + gain) · position + offset, and of the velocity. Not linear, so only advance()'s own rules
// apply.
struct Gauge {
  static constexpr int states = 4, moving = 2, channels = 2;
  std::size_t epochs = 300;
  bool linear = false;
  double jump_at = 1e9;  ///< epoch from which the position's measurement is larger by 1000

  [[nodiscard]] std::size_t size() const { return epochs; }
  [[nodiscard]] Transition<4, 2> transition(const Mat<4>& x, std::size_t k) const {
    const double t = k % 7 == 0 ? 0.3 : 0.1;
    Transition<4, 2> step;
    step.F << 1, t, 0, 1;
    step.Q << t * t * t / 3, t * t / 2, t * t / 2, t;
    step.Q *= 0.2;
    step.mean = step.F * x.head<2>();
    step.walk << 99, 99, 0.0, 1e-4 * t;
    return step;
  }
  void measure(const Mat<4>& x, std::size_t k, Readings<4, 2>& out) const {
    const auto n = static_cast<double>(k);
    out.count = 0;
    if (k % 5 != 3) {
      const double gain = linear ? 0.0 : x(2);
      const double jump = n >= jump_at ? 1000.0 : 0.0;
      out.rows[static_cast<std::size_t>(out.count++)] = {
          jump + std::sin(0.1 * n), (1.0 + gain) * x(0) + x(3), 0.01,
          Mat<4>(1.0 + gain, 0.0, linear ? 0.5 : x(0), 1.0)};
      if (linear) out.rows[0].predicted += 0.5 * x(2);
    }
    if (k % 4 != 1)
      out.rows[static_cast<std::size_t>(out.count++)] = {std::cos(0.1 * n), x(1), 0.09,
                                                         Mat<4>(0, 1, 0, 0)};
  }
  void reopen(Gaussian<4>& x, std::size_t) const {
    x.cov.topRows<2>().setZero();
    x.cov.leftCols<2>().setZero();
    x.cov.topLeftCorner<2, 2>().diagonal().setConstant(1e6);
  }
};
static_assert(StateSpaceModel<Gauge>);

FilterState<4> start() {
  FilterState<4> state;
  state.x.cov.diagonal() << 1.0, 1.0, 0.01, 0.04;
  return state;
}

struct Path {
  std::vector<Mat<4>> means;
  std::vector<Mat<4, 4>> covs;
};

Path smoothed_in_chunks(const Gauge& model, const Gate& gate = {}) {
  Path path{std::vector<Mat<4>>(model.size()), std::vector<Mat<4, 4>>(model.size())};
  smooth(
      model, start(), gate, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const BackwardInformation<4>& later) {
        path.means[k] = later.mean(step.filtered);
        path.covs[k] = later.cov<4>(step.filtered);
      });
  return path;
}

// 300 epochs are three chunks; the gate is active, so its count must be carried across chunks.
TEST(Smoother, InChunksIsTheSameAsInOnePiece) {
  Gauge model;
  model.jump_at = 120.0;
  const Gate gate{.huber = 2.0, .limit = 6.0, .patience = 20};
  const Path chunked = smoothed_in_chunks(model, gate);
  std::vector<Step<4, 2, 2>> steps(model.size());
  FilterState<4> state = start();
  for (std::size_t k = 0; k < model.size(); ++k) advance(model, k, gate, state, steps[k]);
  BackwardInformation<4> later;
  for (std::size_t k = model.size(); k-- > 0;) {
    EXPECT_EQ(later.mean(steps[k].filtered), chunked.means[k]) << "k = " << k;
    EXPECT_EQ(later.cov<4>(steps[k].filtered), chunked.covs[k]) << "k = " << k;
    look_back(later, steps[k]);
  }
}

// The state counts epochs and the step squares it, in chunks of 2 to 5 with and without a thread.
TEST(Smoother, GoesBackOverTheStepsOfTheWayThere) {
  for (const std::size_t size : {0U, 1U, 5U, 8191U, 8192U, 8193U, 20'001U}) {
    std::vector<std::size_t> there, back;
    there_and_back<std::size_t, 2>(
        size, std::size_t{0},
        [](std::size_t& state, std::size_t k, std::size_t& step) {
          step = state * k;
          ++state;
        },
        [&](std::size_t, std::size_t step) { there.push_back(step); },
        [&](std::size_t k, std::size_t step) {
          EXPECT_EQ(step, k * k);
          back.push_back(step);
        });
    std::ranges::reverse(back);
    EXPECT_EQ(there.size(), size);
    EXPECT_EQ(back, there);
  }
}

TEST(Smoother, MeansAloneAreThoseOfTheWholeSmoother) {
  Gauge model;
  model.jump_at = 120.0;
  const Gate gate{.huber = 2.0, .limit = 6.0, .patience = 20};
  const Path whole = smoothed_in_chunks(model, gate);
  smooth_means(
      model, start(), gate, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const BackwardScore<4>& later) {
        EXPECT_EQ(later.mean(step.filtered), whole.means[k]) << "k = " << k;
      });
}

TEST(Smoother, CallsForwardRisingAndBackwardFallingOnceForEachEpoch) {
  const Gauge model{.epochs = 257};
  std::vector<std::size_t> forward, backward;
  smooth(
      model, start(), {}, [&](std::size_t k, const auto&) { forward.push_back(k); },
      [&](std::size_t k, const auto&, const auto&) { backward.push_back(k); });
  ASSERT_EQ(forward.size(), 257U);
  ASSERT_EQ(backward.size(), 257U);
  for (std::size_t k = 0; k < 257; ++k) {
    EXPECT_EQ(forward[k], k);
    EXPECT_EQ(backward[k], 256 - k);
  }
}

// The block of static states is an optimisation; the reference has them in F with ones.
TEST(Smoother, StandingStatesAreStatesWithAnIdentityTransition) {
  Gauge model;
  model.linear = true;
  std::vector<Epoch<2>> epochs;
  std::vector<LinearModel<4, 2>> models;
  for (std::size_t k = 0; k < model.size(); ++k) {
    const auto step = model.transition(Mat<4>::Zero(), k);
    LinearModel<4, 2> dense;
    dense.F.setIdentity();
    dense.F.topLeftCorner<2, 2>() = step.F;
    dense.Q.setZero();
    dense.Q.topLeftCorner<2, 2>() = step.Q;
    dense.Q(3, 3) = step.walk(3);
    dense.H << 1.0, 0.0, 0.5, 1.0, 0.0, 1.0, 0.0, 0.0;
    dense.R << 0.01, 0.09;
    models.push_back(dense);
    const double none = std::numeric_limits<double>::quiet_NaN(), n = static_cast<double>(k);
    epochs.push_back({0.0, Mat<2>(k % 5 == 3 ? none : std::sin(0.1 * n),
                                  k % 4 == 1 ? none : std::cos(0.1 * n))});
  }
  const auto run = smooth_linear(LinearSeries<4, 2>::make(epochs, models).value(), start().x);
  const Path path = smoothed_in_chunks(model);
  for (std::size_t k = 0; k < model.size(); ++k) {
    EXPECT_TRUE(path.means[k].isApprox(run.steps[k].smoothed.mean, 1e-10)) << "k = " << k;
    EXPECT_TRUE(path.covs[k].isApprox(run.steps[k].smoothed.cov.dense(), 1e-10)) << "k = " << k;
  }
}

// The offset is fixed at 0.25: omitted from the arithmetic, or included with zero variance.
struct HeldGauge : Gauge {
  [[nodiscard]] int active() const { return 3; }
  [[nodiscard]] Transition<4, 2> transition(const Mat<4>& x, std::size_t k) const {
    auto step = Gauge::transition(x, k);
    step.walk(3) = 0.0;
    return step;
  }
};
struct WholeGauge : HeldGauge {
  [[nodiscard]] int active() const { return 4; }
};

TEST(Smoother, OnTheActiveStatesEqualsThatOnAllWithoutVarianceOfTheOthers) {
  FilterState<4> begin = start();
  begin.x.mean(3) = 0.25;
  begin.x.cov(3, 3) = 0.0;
  const auto run = [&](const auto& model) {
    Path path{std::vector<Mat<4>>(model.size()), std::vector<Mat<4, 4>>(model.size())};
    smooth(
        model, begin, {}, [](std::size_t, const auto&) {},
        [&](std::size_t k, const auto& step, const BackwardInformation<4>& later) {
          path.means[k] = later.mean(step.filtered);
          path.covs[k] = later.template cov<4>(step.filtered);
        });
    return path;
  };
  const Path held = run(HeldGauge{}), whole = run(WholeGauge{});
  for (std::size_t k = 0; k < held.means.size(); ++k) {
    EXPECT_TRUE(held.means[k].isApprox(whole.means[k], 1e-10)) << "k = " << k;
    EXPECT_TRUE(held.covs[k].isApprox(whole.covs[k], 1e-10)) << "k = " << k;
    EXPECT_EQ(held.means[k](3), 0.25);
  }
}

TEST(Filter, AStepAllocatesNothing) {
  const Gauge model;
  std::vector<Step<4, 2, 2>> steps(model.size());
  FilterState<4> state = start();
  BackwardInformation<4> later;
  const Gate gate{.huber = 1.0, .limit = 2.0, .patience = 3};
  const std::size_t before = test::allocations();
  for (std::size_t k = 0; k < model.size(); ++k) advance(model, k, gate, state, steps[k]);
  for (std::size_t k = model.size(); k-- > 0;) look_back(later, steps[k]);
  EXPECT_EQ(test::allocations() - before, 0U);
  EXPECT_GT(before, 0U) << "the counter does not count";
}

Gaussian<1> unit_normal() {
  Gaussian<1> x;
  x.cov << 1.0;
  return x;
}

Reading<1> reads(double value) {
  return {value, 0.0, 3.0, Mat<1>(1.0)};
}  // S = 4

TEST(Gate, BeyondHuberNoReadingPullsHarderThanOneJustThere) {
  const Gate gate{.huber = 2.0, .limit = 10.0};
  Gaussian<1> just_there = unit_normal(), beyond = unit_normal(), far_beyond = unit_normal();
  (void)correct(just_there, reads(2.0 * 2.0), gate);
  (void)correct(beyond, reads(3.0 * 2.0), gate);
  (void)correct(far_beyond, reads(-9.0 * 2.0), gate);
  EXPECT_DOUBLE_EQ(just_there.mean(0), 1.0);  // K y = (1 / 4) · 4: full weight
  EXPECT_DOUBLE_EQ(beyond.mean(0), 1.0);
  EXPECT_DOUBLE_EQ(far_beyond.mean(0), -1.0);
}

TEST(Gate, AReadingOfLittleWeightIsAReadingOfLargerVariance) {
  Gaussian<1> x = unit_normal();
  const Update<1> update = correct(x, reads(6.0), {.huber = 2.0, .limit = 10.0});
  EXPECT_TRUE(update.used);
  EXPECT_DOUBLE_EQ(update.expected, 4.0);
  EXPECT_DOUBLE_EQ(update.variance, 6.0);          // S · ν / huber
  EXPECT_DOUBLE_EQ(x.cov(0, 0), 1.0 - 1.0 / 6.0);  // P − P² / S
  EXPECT_DOUBLE_EQ(update.nis(), 9.0);             // with the variance stated by the model
}

TEST(Gate, BeyondTheLimitAReadingIsLeftOut) {
  Gaussian<1> x = unit_normal();
  const Update<1> inside = correct(x, reads(9.9 * 2.0), {.limit = 10.0});
  EXPECT_TRUE(inside.used);
  x = unit_normal();
  const Update<1> outside = correct(x, reads(10.1 * 2.0), {.limit = 10.0});
  EXPECT_FALSE(outside.used);
  EXPECT_EQ(outside.gain(0), 0.0);
  EXPECT_EQ(x.mean(0), 0.0);
  EXPECT_EQ(x.cov(0, 0), 1.0);
}

TEST(Gate, ANotANumberIsLeftOut) {
  Gaussian<1> x = unit_normal();
  const Update<1> update =
      correct(x, reads(std::numeric_limits<double>::quiet_NaN()), {.limit = 10.0});
  EXPECT_FALSE(update.used);
  EXPECT_EQ(x.mean(0), 0.0);
}

// Only the position jumps; the velocity is omitted, since its accepted measurements would reset the
// gate's count.
struct JumpingLevel {
  static constexpr int states = 1, moving = 1, channels = 1;
  std::vector<double> z;
  [[nodiscard]] std::size_t size() const { return z.size(); }
  [[nodiscard]] Transition<1, 1> transition(const Mat<1>& x, std::size_t) const {
    return {x, Mat<1>(1.0), Mat<1>(1e-4), Mat<1>(0.0)};
  }
  void measure(const Mat<1>& x, std::size_t k, Readings<1, 1>& out) const {
    out.count = std::isnan(z[k]) ? 0 : 1;
    out.rows[0] = {z[k], x(0), 0.01, Mat<1>(1.0)};
  }
  void reopen(Gaussian<1>& x, std::size_t) const { x.cov << 1e6; }
};

TEST(Gate, AfterItsPatienceTheFilterReopensAndFindsTheSignalAgain) {
  JumpingLevel model{std::vector<double>(100, 0.0)};
  for (std::size_t k = 50; k < 100; ++k) model.z[k] = 500.0;
  model.z[52] = std::numeric_limits<double>::quiet_NaN();  // a missing measurement does not count
  const Gate gate{.huber = 3.0, .limit = 10.0, .patience = 8};
  std::vector<double> means;
  std::vector<int> used;
  FilterState<1> state{unit_normal()};
  filter(model, {0, model.size()}, gate, state, [&](std::size_t, const auto& step) {
    means.push_back(step.filtered.mean(0));
    used.push_back(step.count > 0 && step.updates[0].used ? 1 : 0);
  });
  // Eight measurements are rejected: 50, 51, 53 … 58. After the covariance reset the ninth is used.
  for (std::size_t k = 50; k <= 58; ++k) EXPECT_EQ(used[k], 0) << "k = " << k;
  EXPECT_NEAR(means[58], 0.0, 1e-9);
  EXPECT_EQ(used[59], 1);
  EXPECT_NEAR(means[59], 500.0, 1.0);
  EXPECT_NEAR(means[99], 500.0, 1e-3);
}

TEST(Gate, OneOutlierNeitherMovesTheFilterNorRunsDownItsPatience) {
  JumpingLevel model{std::vector<double>(100, 0.0)};
  for (std::size_t k = 10; k < 100; k += 2) model.z[k] = 500.0;
  FilterState<1> state{unit_normal()};
  filter(model, {0, model.size()}, {.huber = 3.0, .limit = 10.0, .patience = 2}, state,
         [](std::size_t, const auto&) {});
  EXPECT_NEAR(state.x.mean(0), 0.0, 1e-12);
  EXPECT_LT(state.x.cov(0, 0), 0.01);
}

// Two measurements far more precise than the prior: P − K S Kᵀ would lose all digits of P.
TEST(Filter, APriorTenToTheSixteenTimesTheReadingsLosesNoDefiniteness) {
  Gaussian<2> x;
  x.cov << 1e16, 0.99e16, 0.99e16, 1e16;
  (void)correct(x, Reading<2>{1.0, 0.0, 1.0, Mat<2>(1.0, 0.0)}, {});
  (void)correct(x, Reading<2>{1.0, x.mean(0) + x.mean(1), 1.0, Mat<2>(1.0, 1.0)}, {});
  EXPECT_NEAR(x.cov(0, 0), 1.0, 1e-6);
  EXPECT_NEAR(x.cov(1, 1), 2.0, 1e-6);
  EXPECT_NEAR(x.cov(0, 1), -1.0, 1e-6);
  EXPECT_EQ(x.cov(0, 1), x.cov(1, 0));
}

}  // namespace
}  // namespace proofmass::estimate::kalman_test
