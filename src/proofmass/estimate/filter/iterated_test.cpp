#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/filter/iterated_filter.hpp"
#include "proofmass/estimate/filter/iterated_smoother.hpp"
#include "proofmass/estimate/filter/lag_test_support.hpp"

namespace proofmass::estimate::iterated_test {
namespace {

constexpr double gravity_mps2 = 9.80665;

// A pendulum with an accelerometer along its arm: nonlinear dynamics and measurements.
//   θ' = ω, ω' = −(g/l) sin θ by Euler's rule with step h;  z = g sin θ, missing at some epochs.
struct Pendulum {
  static constexpr int states = 2, moving = 2, channels = 1;
  std::vector<double> z;
  double h = 0.05, rate2 = gravity_mps2 / 0.5, variance = 0.3;

  [[nodiscard]] std::size_t size() const { return z.size(); }
  [[nodiscard]] Transition<2, 2> transition(const Mat<2>& x, std::size_t) const {
    Transition<2, 2> step;
    step.mean << x(0) + h * x(1), x(1) - h * rate2 * std::sin(x(0));
    step.F << 1.0, h, -h * rate2 * std::cos(x(0)), 1.0;
    step.Q << h * h * h / 3, h * h / 2, h * h / 2, h;
    step.Q *= 0.5;
    step.walk.setZero();
    return step;
  }
  void measure(const Mat<2>& x, std::size_t k, Readings<2, 1>& out) const {
    out.count = std::isnan(z[k]) ? 0 : 1;
    out.rows[0] = {z[k], gravity_mps2 * std::sin(x(0)), variance,
                   Mat<2>(gravity_mps2 * std::cos(x(0)), 0.0)};
  }
  void reopen(Gaussian<2>&, std::size_t) const {}
};

FilterState<2> pendulum_start() {
  FilterState<2> start;
  start.x.mean << 0.5, 0.0;
  start.x.cov << 0.3, 0.05, 0.05, 1.0;
  return start;
}

Pendulum oscillating(std::size_t count) {
  Pendulum pendulum;
  pendulum.z.assign(count, 0.0);
  Random random(4, "pendulum");
  Mat<2> x(1.4, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0) {
      const auto step = pendulum.transition(x, k);
      const Eigen::LLT<Mat<2, 2>> root(step.Q);
      x = step.mean + root.matrixL() * Mat<2>(random.normal(), random.normal());
    }
    pendulum.z[k] = gravity_mps2 * std::sin(x(0)) + std::sqrt(0.3) * random.normal();
    if (k % 6 == 4) pendulum.z[k] = std::numeric_limits<double>::quiet_NaN();
  }
  return pendulum;
}

// All states at once: Gauss–Newton on the joint posterior with a dense matrix, written down term by
// term from the model, without recursion.
struct Dense {
  Eigen::VectorXd x;
  Eigen::MatrixXd information;
};
Dense dense_step(const Pendulum& pendulum, const Eigen::VectorXd& x) {
  const Eigen::Index size = x.size();
  Dense out{Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  const Gaussian<2> prior = pendulum_start().x;
  const Eigen::LLT<Mat<2, 2>> P(prior.cov);
  out.information.topLeftCorner<2, 2>() += P.solve(Mat<2, 2>::Identity());
  out.x.head<2>() += P.solve(prior.mean - x.head<2>());
  for (Eigen::Index at = 0; at < size; at += 2) {
    const auto k = static_cast<std::size_t>(at / 2);
    Readings<2, 1> readings;
    pendulum.measure(x.segment<2>(at), k, readings);
    if (readings.count > 0) {
      const auto& r = readings.rows[0];
      out.information.block<2, 2>(at, at) += r.h * r.h.transpose() / r.variance;
      out.x.segment<2>(at) += r.h * (r.value - r.predicted) / r.variance;
    }
    if (at == 0) continue;
    const auto step = pendulum.transition(x.segment<2>(at - 2), k);
    Mat<2, 4> J;
    J << -step.F, Mat<2, 2>::Identity();
    const Eigen::LLT<Mat<2, 2>> Q(step.Q);
    out.information.block<4, 4>(at - 2, at - 2) += J.transpose() * Q.solve(J);
    out.x.segment<4>(at - 2) += J.transpose() * Q.solve(step.mean - x.segment<2>(at));
  }
  out.x = x + out.information.llt().solve(out.x);
  return out;
}

std::vector<Mat<2>> path_of(const Eigen::VectorXd& x) {
  std::vector<Mat<2>> path;
  for (Eigen::Index at = 0; at < x.size(); at += 2) path.emplace_back(x.segment<2>(at));
  return path;
}

TEST(IteratedSmoother, IsTheMostProbablePathFoundWithoutRecursion) {
  const Pendulum pendulum = oscillating(60);
  const auto run = smooth_iterated(pendulum, pendulum_start());
  ASSERT_TRUE(run.how.converged) << run.how.iterations << " " << run.how.change;
  Eigen::VectorXd x(120);
  for (std::size_t k = 0; k < 60; ++k)
    x.segment<2>(static_cast<Eigen::Index>(2 * k)) = run.states[k].mean + Mat<2>(0.02, -0.03);
  Dense dense;
  for (int i = 0; i < 30; ++i) {
    dense = dense_step(pendulum, x);
    x = dense.x;
  }
  const Eigen::MatrixXd cov = dense.information.llt().solve(Eigen::MatrixXd::Identity(120, 120));
  for (std::size_t k = 0; k < 60; ++k) {
    const auto at = static_cast<Eigen::Index>(2 * k);
    const Gaussian<2> expected{x.segment<2>(at), cov.block<2, 2>(at, at)};
    EXPECT_LT(test::distance<2>(run.states[k].mean, expected), 1e-9) << "k = " << k;
    EXPECT_LT(test::distance<2>(run.states[k].cov, expected.cov), 1e-9) << "k = " << k;
  }
  EXPECT_NEAR(run.objective, objective(pendulum, pendulum_start().x, path_of(x)), 1e-9);
}

TEST(IteratedSmoother, FindsALessImprobablePathThanThePlainOne) {
  const Pendulum pendulum = oscillating(60);
  const auto plain = smooth_iterated(pendulum, pendulum_start(), {}, {.iterations = 1});
  const auto run = smooth_iterated(pendulum, pendulum_start());
  EXPECT_FALSE(plain.how.converged);
  EXPECT_LT(run.objective, plain.objective - 0.01);
}

TEST(IteratedSmoother, OfOneIterationIsThePlainExtendedOne) {
  const Pendulum pendulum = oscillating(200);
  const auto run = smooth_iterated(pendulum, pendulum_start(), {}, {.iterations = 1});
  EXPECT_EQ(run.how.iterations, 1);
  smooth(
      pendulum, pendulum_start(), {}, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const BackwardInformation<2>& later) {
        EXPECT_EQ(run.states[k].mean, later.mean(step.filtered));
        EXPECT_EQ(run.states[k].cov, later.cov<2>(step.filtered));
      });
}

TEST(IteratedSmoother, OfALinearModelIsTheLinearSmootherInTwo) {
  auto series = test::uneven_series(80);
  const FilterState<3> prior{test::oscillator_prior()};
  const auto run = smooth_iterated(series, prior);
  EXPECT_TRUE(run.how.converged);
  EXPECT_EQ(run.how.iterations, 2);
  smooth(
      series, prior, {}, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const BackwardInformation<3>& later) {
        const Gaussian<3> expected{later.mean(step.filtered), later.cov<3>(step.filtered)};
        EXPECT_LT(test::distance<3>(run.states[k].mean, expected), 1e-11) << "k = " << k;
      });
}

TEST(IteratedSmoother, SaysThatItHasNotConverged) {
  const auto run = smooth_iterated(oscillating(60), pendulum_start(), {}, {.iterations = 2});
  EXPECT_FALSE(run.how.converged);
  EXPECT_EQ(run.how.iterations, 2);
  EXPECT_GT(run.how.change, 1e-10);
}

TEST(IteratedSmoother, OfNothingIsNothing) {
  const auto run = smooth_iterated(Pendulum{}, pendulum_start());
  EXPECT_TRUE(run.states.empty());
  EXPECT_EQ(run.objective, 0.0);
}

// A dynamic level, and an offset with a random walk.
struct Level {
  static constexpr int states = 2, moving = 1, channels = 2;
  [[nodiscard]] std::size_t size() const { return 12; }
  [[nodiscard]] Transition<2, 1> transition(const Mat<2>& x, std::size_t) const {
    return {Mat<1>(0.9 * x(0)), Mat<1>(0.9), Mat<1>(0.2), Mat<2>(99.0, 0.05)};
  }
  void measure(const Mat<2>& x, std::size_t k, Readings<2, 2>& out) const {
    out.count = 2;
    const double t = static_cast<double>(k);
    out.rows[0] = {std::sin(t), x(0) + x(1), 0.1, Mat<2>(1.0, 1.0)};
    out.rows[1] = {std::cos(3.0 * t), x(1), 0.3, Mat<2>(0.0, 1.0)};
  }
  void reopen(Gaussian<2>&, std::size_t) const {}
};

TEST(Objective, IsLeastAtTheSmoothedPathOfALinearModel) {
  FilterState<2> start;
  start.x.cov.diagonal() << 1.0, 0.5;
  std::vector<Mat<2>> path;
  for (const auto& x : smooth_iterated(Level{}, start).states) path.push_back(x.mean);
  for (Mat<2>& x : path)
    for (int i = 0; i < 2; ++i) {
      const double here = x(i);
      x(i) = here + 1e-3;
      const double above = objective(Level{}, start.x, path);
      x(i) = here - 1e-3;
      const double below = objective(Level{}, start.x, path);
      x(i) = here;
      EXPECT_NEAR(above, below, 1e-12);
    }
}

// The measurement is the arctangent: from 3 on, full Gauss–Newton steps diverge with alternating
// sign.
struct Arc {
  static constexpr int states = 1, moving = 1, channels = 1;
  [[nodiscard]] std::size_t size() const { return 1; }
  [[nodiscard]] Transition<1, 1> transition(const Mat<1>& x, std::size_t) const {
    return {x, Mat<1>(1.0), Mat<1>(1.0), Mat<1>(0.0)};
  }
  void measure(const Mat<1>& x, std::size_t, Readings<1, 1>& out) const {
    out.count = 1;
    out.rows[0] = {0.0, std::atan(x(0)), 1e-8, Mat<1>(1.0 / (1.0 + x(0) * x(0)))};
  }
  void reopen(Gaussian<1>&, std::size_t) const {}
};

TEST(IteratedFilter, HalvesStepsThatLeadAway) {
  FilterState<1> state;
  state.x = {Mat<1>(3.0), Mat<1>(1e6)};
  StepOf<Arc> step;
  EXPECT_TRUE(advance_iterated(Arc{}, 0, {}, state, step).converged);
  EXPECT_NEAR(state.x.mean(0), 0.0, 1e-9);
}

TEST(IteratedSmoother, HalvesStepsThatLeadAway) {
  FilterState<1> start;
  start.x = {Mat<1>(3.0), Mat<1>(1e6)};
  const auto run = smooth_iterated(Arc{}, start);
  EXPECT_TRUE(run.how.converged);
  EXPECT_NEAR(run.states[0].mean(0), 0.0, 1e-9);
}

// A walker in the plane with ranges to one or two beacons: the shorter the range, the stronger its
// nonlinearity.
struct Walker {
  static constexpr int states = 4, moving = 4, channels = 2;
  std::vector<Mat<2>> ranges;

  [[nodiscard]] std::size_t size() const { return ranges.size(); }
  [[nodiscard]] Transition<4, 4> transition(const Mat<4>& x, std::size_t) const {
    Transition<4, 4> step;
    step.F.setIdentity();
    step.F(0, 2) = step.F(1, 3) = 0.5;
    step.mean = step.F * x;
    step.Q.setZero();  // of rank 2
    for (int i = 0; i < 2; ++i) {
      step.Q(i, i) = 0.5 * 0.5 * 0.5 * 0.5 / 4;
      step.Q(i, i + 2) = step.Q(i + 2, i) = 0.5 * 0.5 * 0.5 / 2;
      step.Q(i + 2, i + 2) = 0.5 * 0.5;
    }
    step.Q *= 0.04;
    step.walk.setZero();
    return step;
  }
  void measure(const Mat<4>& x, std::size_t k, Readings<4, 2>& out) const {
    out.count = 0;
    for (int i = 0; i < 2; ++i) {
      if (std::isnan(ranges[k](i))) continue;
      const Mat<2> away = x.head<2>() - (i == 0 ? Mat<2>(0.0, 0.0) : Mat<2>(6.0, 1.0));
      Mat<4> h = Mat<4>::Zero();
      h.head<2>() = away.normalized();
      out.rows[static_cast<std::size_t>(out.count++)] = {ranges[k](i), away.norm(), 1e-4, h};
    }
  }
  void reopen(Gaussian<4>&, std::size_t) const {}
};

// Newton's method with a dense Hessian from differences of the exact gradient, started at the best
// point of a grid.
Mat<4> most_probable(const Walker& walker, const Gaussian<4>& prior, std::size_t k) {
  const auto gradient = [&](const Mat<4>& x) {
    Readings<4, 2> readings;
    walker.measure(x, k, readings);
    Mat<4> g = prior.cov.llt().solve(x - prior.mean);
    for (int i = 0; i < readings.count; ++i) {
      const auto& r = readings.rows[static_cast<std::size_t>(i)];
      g -= r.h * (r.value - r.predicted) / r.variance;
    }
    return g;
  };
  const auto cost = [&](const Mat<4>& x) {
    return detail::misfit(walker, x, k) +
           (x - prior.mean).dot(prior.cov.llt().solve(x - prior.mean));
  };
  Mat<4> best = prior.mean;
  for (int i = -60; i <= 60; ++i)
    for (int j = -60; j <= 60; ++j) {
      const Mat<4> x = prior.mean + Mat<4>(0.05 * i, 0.05 * j, 0.0, 0.0);
      if (cost(x) < cost(best)) best = x;
    }
  for (int round = 0; round < 100; ++round) {
    Mat<4, 4> hessian;
    for (int c = 0; c < 4; ++c) {
      const Mat<4> d = 1e-5 * Mat<4>::Unit(c);
      hessian.col(c) = (gradient(best + d) - gradient(best - d)) / 2e-5;
    }
    best -= hessian.partialPivLu().solve(gradient(best));
  }
  return best;
}

FilterState<4> walker_start() {
  FilterState<4> start;
  start.x.mean << 2.0, 1.5, 0.3, -0.2;
  start.x.cov.diagonal() << 2.0, 0.3, 0.04, 0.04;
  start.x.cov(0, 2) = start.x.cov(2, 0) = 0.05;
  return start;
}

TEST(IteratedFilter, IsTheMostProbableStateFoundWithoutTheFilter) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const Mat<2>& range : {Mat<2>(1.3, none), Mat<2>(3.6, 4.9), Mat<2>(none, 5.2)}) {
    const Walker walker{{range}};
    FilterState<4> state = walker_start(), plain = walker_start();
    StepOf<Walker> step;
    const Iterated how = advance_iterated(walker, 0, {}, state, step, {.iterations = 200});
    EXPECT_TRUE(how.converged);
    advance(walker, 0, {}, plain, step);
    const Gaussian<4> expected{most_probable(walker, walker_start().x, 0), state.x.cov};
    EXPECT_LT(test::distance<4>(state.x.mean, expected), 1e-9) << range.transpose();
    EXPECT_GT(test::distance<4>(plain.x.mean, expected), 0.01) << "too easy";
  }
}

TEST(IteratedFilter, OfOneIterationIsThePlainExtendedOne) {
  const Pendulum pendulum = oscillating(100);
  FilterState<2> once = pendulum_start(), plain = once;
  StepOf<Pendulum> step;
  for (std::size_t k = 0; k < pendulum.size(); ++k) {
    const Iterated how = advance_iterated(pendulum, k, {}, once, step, {.iterations = 1});
    EXPECT_EQ(how.iterations, 1);
    advance(pendulum, k, {}, plain, step);
    ASSERT_EQ(once.x.mean, plain.x.mean);
    ASSERT_EQ(once.x.cov, plain.x.cov);
  }
}

TEST(IteratedFilter, OfALinearModelIsTheLinearFilterInTwo) {
  const auto series = test::uneven_series(100);
  FilterState<3> state{test::oscillator_prior()}, linear = state;
  StepOf<LinearSeries<3, 2, 1>> step;
  const auto how = filter_iterated(series, {}, state, [&](std::size_t k, const auto& now) {
    advance(series, k, {}, linear, step);
    EXPECT_LT(test::distance<3>(now.filtered.mean, linear.x), 1e-12) << "k = " << k;
  });
  EXPECT_EQ(how.unconverged, 0U);
  EXPECT_EQ(how.most_iterations, 2);
}

TEST(IteratedFilter, ThatDoesNotConvergeIsThePlainExtendedOneAndSaysSo) {
  const Walker walker{{Mat<2>(1.3, 5.5)}};
  FilterState<4> state = walker_start(), plain = state;
  StepOf<Walker> step;
  const Iterated how = advance_iterated(walker, 0, {}, state, step, {.iterations = 2});
  EXPECT_FALSE(how.converged);
  EXPECT_GT(how.change, 0.0);
  advance(walker, 0, {}, plain, step);
  EXPECT_EQ(state.x.mean, plain.x.mean);
  EXPECT_EQ(state.x.cov, plain.x.cov);
}

TEST(IteratedFilter, AStepAllocatesNothing) {
  const Pendulum pendulum = oscillating(50);
  FilterState<2> state = pendulum_start();
  const std::size_t before = test::allocations();
  (void)filter_iterated(pendulum, {}, state, [](std::size_t, const auto&) {});
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace proofmass::estimate::iterated_test
