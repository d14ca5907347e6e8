#include "proofmass/estimate/models/bias_models.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace proofmass::estimate::bias_models_test {
namespace {

/// Table 4.1 of the thesis.
const sensor::WarmUp warm_up{.a1_mps2 = 0.25, .a2_mps2 = -0.21, .time_constant_s = 70.0};

RestOptions rest(double dt_s) {
  return {.bias = {.dt_s = dt_s, .time_constant_s = 70.0, .bias_psd_m2ps5 = 1e-8},
          .accel_variance_m2ps4 = 4e-4};
}

/// Model of the bias in a filter without a warm-up.
RestOptions rest_without_warm_up(double dt_s) {
  RestOptions options = rest(dt_s);
  options.bias.time_constant_s = 1e9;
  return options;
}

PvaBiasOptions moving(double dt_s) {
  return {.motion = {.dt_s = dt_s, .jerk_psd_m2ps5 = 1e-4, .accel_variance_m2ps4 = 4e-4},
          .time_constant_s = 70.0,
          .bias_psd_m2ps5 = 1e-8};
}

TEST(BiasModel, TwoStepsEqualOneOfTwiceTheLength) {
  for (const double dt_s : {1e-3, 0.5, 35.0, 700.0}) {
    const LinearModel<1, 1, 1> one = bias_model(rest(dt_s)), two = bias_model(rest(2.0 * dt_s));
    const double F = one.F.value(), Q = one.Q.value(), B = one.B.value();
    EXPECT_NEAR(two.F.value(), F * F, 1e-15) << dt_s;
    EXPECT_NEAR(two.Q.value(), F * Q * F + Q, 1e-14 * two.Q.value()) << dt_s;
    EXPECT_NEAR(two.B.value(), F * B + B, 1e-15) << dt_s;
  }
}

TEST(BiasModel, WithTheInputItFollowsTheWarmUpWhateverTheSteps) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> length_s(0.0, 2.0);
  double bias_mps2 = warm_up.a2_mps2, t_s = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double dt_s = length_s(random);
    const LinearModel<1, 1, 1> model = bias_model(rest(dt_s));
    bias_mps2 = model.F.value() * bias_mps2 + model.B.value() * warm_up.settled_mps2();
    t_s += dt_s;
    ASSERT_NEAR(bias_mps2, sensor::bias_at(warm_up, t_s).value, 1e-14) << "t = " << t_s;
  }
}

TEST(BiasModel, ItsNoiseIsARandomWalkAtFirstAndStationaryAtLast) {
  EXPECT_NEAR(bias_step(rest(1e-3).bias).variance_m2ps4, 1e-11 * (1.0 - 1e-3 / 70.0), 1e-20);
  EXPECT_DOUBLE_EQ(bias_step(rest(1e4).bias).variance_m2ps4, 1e-8 * 0.5 * 70.0);
}

TEST(BiasModel, ItsPriorIsTheWarmUpAtThatTime) {
  sensor::WarmUp uncertain = warm_up;
  uncertain.covariance = {{{4e-4, 0.0, 0.0}, {0.0, 1e-4, 0.0}, {0.0, 0.0, 25.0}}};
  const Gaussian<1> prior = bias_prior(uncertain, 30.0);
  const Uncertain bias = sensor::bias_at(uncertain, 30.0);
  EXPECT_EQ(prior.mean.value(), bias.value);
  EXPECT_DOUBLE_EQ(prior.cov.value(), bias.std * bias.std);
  EXPECT_NEAR(bias_prior(sensor::departure(uncertain), 1e5).mean.value(), 0.0, 1e-15);
}

// Source: M. A. Lele (2010), appendix A.1; this is its structure for one pair of sensors.
TEST(WithBias, TwiceGivesEachBiasItsOwnInputAndChannel) {
  const LinearModel<3, 1> motion = pva_model(moving(0.1).motion);
  LinearModel<3, 2> seen_twice{motion.F, motion.Q, {}, {}};
  seen_twice.H << motion.H, motion.H;
  seen_twice.R << 0.01, 0.02;
  BiasOptions slow = rest(0.1).bias;
  slow.time_constant_s = 500.0;
  const BiasStep fast_step = bias_step(rest(0.1).bias), slow_step = bias_step(slow);
  const LinearModel<5, 2, 2> model =
      with_bias(with_bias(seen_twice, fast_step, {1.0, 0.0}), slow_step, {0.0, 1.0});
  Mat<2, 5> H;
  H << 0, 0, 1, 1, 0,  //
      0, 0, 1, 0, 1;
  Mat<5, 2> B = Mat<5, 2>::Zero();
  B(3, 0) = fast_step.settled;
  B(4, 1) = slow_step.settled;
  EXPECT_EQ(model.H, H);
  EXPECT_EQ(model.B, B);
  EXPECT_EQ((model.F.topLeftCorner<3, 3>()), motion.F);
  EXPECT_EQ(model.F(3, 3), fast_step.phi);
  EXPECT_EQ(model.F(4, 4), slow_step.phi);
  EXPECT_EQ(model.Q(4, 4), slow_step.variance_m2ps4);
  EXPECT_EQ(model.F.col(4).head<4>().norm() + model.F.row(4).head<4>().norm(), 0.0);
  EXPECT_EQ(model.R, seen_twice.R);
}

TEST(WithBias, MakesTheModelOfMotionAndBias) {
  const PvaBiasOptions options = moving(0.1);
  const LinearModel<4, 1, 1> made =
      with_bias(pva_model(options.motion), bias_step(rest(0.1).bias), Mat<1>(1.0));
  const LinearModel<4, 1, 1> known = pva_bias_model(options);
  EXPECT_EQ(made.F, known.F);
  EXPECT_EQ(made.Q, known.Q);
  EXPECT_EQ(made.H, known.H);
  EXPECT_EQ(made.B, known.B);
}

/// Truth and measurements drawn from the model itself, with a state drawn from the prior.
template <int N>
struct Drawn {
  std::vector<Epoch<1, 1>> epochs;
  std::vector<Mat<N>> truth;
};

template <int N>
Drawn<N> draw(const LinearModel<N, 1, 1>& model,
              const Gaussian<N>& prior,
              std::size_t size,
              std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto root = [](const Mat<N, N>& A) {
    const SymmetricEigen eigen = symmetric_eigen(A);
    const Eigen::VectorXd roots = eigen.values.cwiseMax(0.0).cwiseSqrt();
    return Mat<N, N>(eigen.vectors * roots.asDiagonal());
  };
  const auto white = [&] { return Mat<N>(Mat<N>::NullaryExpr([&] { return normal(random); })); };
  const Mat<N, N> root_q = root(model.Q);
  const Mat<1> u(warm_up.settled_mps2());
  Drawn<N> drawn;
  Mat<N> x = prior.mean + root(prior.cov) * white();
  for (std::size_t k = 0; k < size; ++k) {
    if (k > 0) x = (model.F * x + model.B * u + root_q * white()).eval();
    Epoch<1, 1> epoch{.dt_s = k > 0 ? 1.0 : 0.0, .z = model.H * x, .u = u};
    epoch.z(0) += std::sqrt(model.R.value()) * normal(random);
    drawn.epochs.push_back(epoch);
    drawn.truth.push_back(x);
  }
  return drawn;
}

struct Judged {
  double nis = 0.0;          ///< mean over measurements
  double nees = 0.0;         ///< mean over runs, at the last state
  double worst_sigma = 0.0;  ///< largest error of the bias in standard deviations
  std::size_t readings = 0;
};

/// Many runs of a filter on data generated by the model `made_by`.
template <int N>
Judged judge(const LinearModel<N, 1, 1>& made_by,
             const LinearModel<N, 1, 1>& taken_for,
             const Gaussian<N>& prior,
             int runs) {
  std::mt19937_64 random(2010);
  Judged judged;
  for (int run = 0; run < runs; ++run) {
    const Drawn<N> drawn = draw(made_by, prior, 400, random);
    const auto series =
        LinearSeries<N, 1, 1>::make(drawn.epochs, std::vector(drawn.epochs.size(), taken_for));
    const LinearRun<N, 1> result = filter_linear(series.value(), prior);
    judged.nis += result.nis;
    judged.readings += result.readings;
    for (std::size_t k = 0; k < drawn.truth.size(); ++k) {
      const Gaussian<N>& x = result.steps[k].filtered;
      const double off = x.mean(N - 1) - drawn.truth[k](N - 1);
      judged.worst_sigma =
          std::max(judged.worst_sigma, std::abs(off) / std::sqrt(x.cov(N - 1, N - 1)));
    }
    const Gaussian<N>& last = result.steps.back().filtered;
    const Eigen::VectorXd error = last.mean - drawn.truth.back();
    judged.nees += error.dot(positive_inverse(last.cov) * error) / runs;
  }
  judged.nis /= static_cast<double>(judged.readings);
  return judged;
}

constexpr int runs = 40;

/// 99.9 % limits of the mean of `runs` chi-square variables.
Bounds mean_of_runs(int degrees) {
  const double n = runs * degrees;
  return {chi_square_quantile(5e-4, n) / runs, chi_square_quantile(1.0 - 5e-4, n) / runs};
}

Gaussian<1> rest_prior() {
  Gaussian<1> prior;
  prior.mean << warm_up.a2_mps2;
  prior.cov << 1e-6;
  return prior;
}

Gaussian<4> moving_prior() {
  Gaussian<4> prior;
  prior.mean(pva::bias_mps2) = warm_up.a2_mps2;
  prior.cov.diagonal() << 1e-6, 1e-6, 1e-4, 1e-6;
  return prior;
}

TEST(WarmUpAsInput, KeepsABiasFilterConsistent) {
  const LinearModel<1, 1, 1> model = bias_model(rest(1.0));
  const Judged judged = judge(model, model, rest_prior(), runs);
  const Bounds nis = mean_chi_square_95(judged.readings), nees = mean_of_runs(1);
  EXPECT_GT(judged.nis, nis.lower);
  EXPECT_LT(judged.nis, nis.upper);
  EXPECT_GT(judged.nees, nees.lower);
  EXPECT_LT(judged.nees, nees.upper);
  EXPECT_LT(judged.worst_sigma, 5.0);
}

TEST(WarmUpAsInput, WithoutItTheErrorLeavesItsBand) {
  const Judged judged =
      judge(bias_model(rest(1.0)), bias_model(rest_without_warm_up(1.0)), rest_prior(), runs);
  EXPECT_GT(judged.nis, 2.0 * mean_chi_square_95(judged.readings).upper);
  EXPECT_GT(judged.worst_sigma, 20.0);
}

TEST(WarmUpAsInput, KeepsMotionAndBiasConsistent) {
  const LinearModel<4, 1, 1> model = pva_bias_model(moving(1.0));
  const Judged judged = judge(model, model, moving_prior(), runs);
  const Bounds nis = mean_chi_square_95(judged.readings), nees = mean_of_runs(4);
  EXPECT_GT(judged.nis, nis.lower);
  EXPECT_LT(judged.nis, nis.upper);
  EXPECT_GT(judged.nees, nees.lower);
  EXPECT_LT(judged.nees, nees.upper);
  EXPECT_LT(judged.worst_sigma, 5.0);
}

TEST(WarmUpAsInput, WithoutItTheMotionIsWrongByMoreThanItsBand) {
  PvaBiasOptions ignorant = moving(1.0);
  ignorant.time_constant_s = 1e9;
  const Judged judged =
      judge(pva_bias_model(moving(1.0)), pva_bias_model(ignorant), moving_prior(), runs);
  EXPECT_GT(judged.nees, 10.0 * mean_of_runs(4).upper);
  EXPECT_GT(judged.worst_sigma, 20.0);
}

}  // namespace
}  // namespace proofmass::estimate::bias_models_test
