#include <Eigen/Core>
#include <functional>
#include <gtest/gtest.h>
#include <string>

#include "proofmass/estimate/models/angular_model.hpp"
#include "proofmass/estimate/models/fusion_model.hpp"

// Every model compared with the integral of its continuous form, and with two half steps.
namespace proofmass::estimate::discretisation_test {
namespace {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// exp(A) by the Taylor series of A/2ⁿ, squared n times.
Matrix exponential(const Matrix& A) {
  int squarings = 0;
  Matrix scaled = A;
  for (; scaled.cwiseAbs().maxCoeff() > 0.1L; ++squarings) scaled *= 0.5L;
  Matrix sum = Matrix::Identity(A.rows(), A.cols()), term = sum;
  for (int n = 1; n < 25; ++n) {
    term = (term * scaled / static_cast<long double>(n)).eval();
    sum += term;
  }
  for (; squarings > 0; --squarings) sum = (sum * sum).eval();
  return sum;
}

struct Discrete {
  Eigen::MatrixXd F, Q;
};

/// x' = A x + w with E w wᵀ = W δ, over a step: C. F. Van Loan, Computing integrals involving the
/// matrix exponential, IEEE Trans. Autom. Control 23 (1978) 395.
Discrete van_loan(const Eigen::MatrixXd& A, const Eigen::MatrixXd& W, double dt) {
  const Eigen::Index n = A.rows();
  Matrix M = Matrix::Zero(2 * n, 2 * n);
  M.topLeftCorner(n, n) = -A.cast<long double>();
  M.topRightCorner(n, n) = W.cast<long double>();
  M.bottomRightCorner(n, n) = A.transpose().cast<long double>();
  const Matrix E = exponential(M * static_cast<long double>(dt));
  const Matrix F = E.bottomRightCorner(n, n).transpose();
  return {F.cast<double>(), (F * E.topRightCorner(n, n)).cast<double>()};
}

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      if (const double size = std::abs(b(i, j)); size > 0.0)
        worst = std::max(worst, std::abs(a(i, j) - b(i, j)) / size);
      else
        worst = std::max(worst, std::abs(a(i, j)));
  return worst;
}

struct Case {
  std::string name;
  Eigen::MatrixXd A, W;
  std::function<Discrete(double dt)> model;
  /// Beyond this step van Loan's e^(+dt/T) e^(−dt/T) loses precision.
  double longest_dt = 20.0;
};

Eigen::MatrixXd zero(Eigen::Index n) {
  return Eigen::MatrixXd::Zero(n, n);
}

template <class Model>
Discrete discrete(const Model& model) {
  return {model.F, model.Q};
}

Case pva_case() {
  Eigen::MatrixXd A = zero(3), W = zero(3);
  A(0, 1) = A(1, 2) = 1.0;
  W(2, 2) = 0.3;
  return {"pva", A, W, [](double dt) { return discrete(pva_model({dt, 0.3, 1.0})); }};
}

Case pva_bias_case() {
  Case out = pva_case();
  out.name = "pva and bias";
  out.A.conservativeResizeLike(zero(4));
  out.W.conservativeResizeLike(zero(4));
  out.A(3, 3) = -1.0 / 7.0;
  out.W(3, 3) = 0.02;
  out.model = [](double dt) { return discrete(pva_bias_model({{dt, 0.3, 1.0}, 7.0, 0.02})); };
  return out;
}

Case singer_case() {
  Case out = pva_case();
  out.name = "singer";
  out.A(2, 2) = -1.0 / 0.7;
  out.W(2, 2) = 2.0 * 1.5 * 1.5 / 0.7;
  out.model = [](double dt) { return discrete(singer_model({dt, 0.7, 1.5, 1.0})); };
  out.longest_dt = 2.0;
  return out;
}

Case angular_case() {
  Case out = pva_bias_case();
  out.name = "angular";
  out.model = [](double dt) {
    return discrete(angular_model({.dt_s = dt,
                                   .jerk_psd_rad2ps5 = 0.3,
                                   .bias_time_constant_s = 7.0,
                                   .bias_psd_rad2ps5 = 0.02,
                                   .accel_variance_rad2ps4 = 1.0}));
  };
  return out;
}

Case tilt_case() {
  Eigen::MatrixXd A = zero(2), W = zero(2);
  A(0, 1) = -1.0;
  W(0, 0) = 0.04;
  W(1, 1) = 0.003;
  return {"tilt", A, W,
          [](double dt) { return discrete(tilt_rate_model({dt, 0.04, 0.003, 1.0})); }};
}

FusionModelOptions fusion_options(double dt) {
  FusionModelOptions options;
  for (int i = 0; i < fusion::axes; ++i)
    options.axes[static_cast<std::size_t>(i)] = {dt, 0.1 + 0.2 * i, 0.01 + 0.01 * i};
  options.bias_x = {dt, 5.0, 0.02};
  options.bias_y = {dt, 9.0, 0.03};
  return options;
}

Case fusion_case() {
  Eigen::MatrixXd A = zero(14), W = zero(14);
  for (int i = 0; i < fusion::axes; ++i) {
    A(3 * i, 3 * i + 1) = A(3 * i + 1, 3 * i + 2) = 1.0;
    W(3 * i + 2, 3 * i + 2) = 0.1 + 0.2 * i;
  }
  A(12, 12) = -1.0 / 5.0;
  A(13, 13) = -1.0 / 9.0;
  W(12, 12) = 0.02;
  W(13, 13) = 0.03;
  return {"fusion", A, W, [](double dt) { return discrete(fusion_model(fusion_options(dt))); }};
}

std::vector<Case> cases() {
  return {pva_case(), pva_bias_case(), singer_case(), angular_case(), tilt_case(), fusion_case()};
}

TEST(Discretisation, IsVanLoans) {
  for (const Case& model : cases())
    for (const double dt : {1e-3, 0.005, 0.1, 0.69, 0.71, 2.0, 10.0}) {
      if (dt > model.longest_dt) continue;
      const Discrete ours = model.model(dt), theirs = van_loan(model.A, model.W, dt);
      EXPECT_LT(relative(ours.F, theirs.F), 1e-13) << model.name << ", dt = " << dt;
      EXPECT_LT(relative(ours.Q, theirs.Q), 1e-13) << model.name << ", dt = " << dt;
    }
}

TEST(Discretisation, TwoStepsEqualOneOfTwiceTheLength) {
  for (const Case& model : cases())
    for (const double dt : {1e-4, 0.01, 0.35, 1.0, 30.0}) {
      const Discrete one = model.model(dt), two = model.model(2.0 * dt);
      EXPECT_LT((one.F * one.F - two.F).cwiseAbs().maxCoeff(), 1e-15 * two.F.maxCoeff())
          << model.name << ", dt = " << dt;
      EXPECT_LT(relative(one.F * one.Q * one.F.transpose() + one.Q, two.Q), 1e-13)
          << model.name << ", dt = " << dt;
    }
}

TEST(Discretisation, AStepOfZeroDurationChangesNothing) {
  for (const Case& model : cases()) {
    const Discrete none = model.model(0.0);
    EXPECT_TRUE(none.F.isIdentity(0.0)) << model.name;
    EXPECT_TRUE(none.Q.isZero(0.0)) << model.name;
  }
}

TEST(Singer, ForShortStepsIsWhiteJerkOfItsDensity) {
  const double dt = 1e-5, tau = 100.0, std = 2.0;
  const LinearModel<3, 1> singer = singer_model({dt, tau, std, 1.0});
  const LinearModel<3, 1> pva = pva_model({dt, 2.0 * std * std / tau, 1.0});
  EXPECT_LT(relative(singer.Q, pva.Q), 1e-6);
  EXPECT_LT(relative(singer.F, pva.F), 1e-6);
}

TEST(Singer, AfterManyManeuverTimesTheAccelerationHasItsVariance) {
  const LinearModel<3, 1> model = singer_model({500.0, 2.0, 3.0, 0.1});
  EXPECT_NEAR(model.Q(pva::accel_mps2, pva::accel_mps2), 9.0, 1e-12);
  EXPECT_NEAR(model.F(pva::accel_mps2, pva::accel_mps2), 0.0, 1e-100);
  EXPECT_DOUBLE_EQ(model.R.value(), 0.1);
}

TEST(GaussMarkovBias, KeepsItsVariance) {
  const BiasStep step = gauss_markov_step({0.5, 3.0, 0.2});
  EXPECT_NEAR(step.phi * step.phi * 0.04 + step.variance_m2ps4, 0.04, 1e-16);
  EXPECT_DOUBLE_EQ(step.phi + step.settled, 1.0);
}

TEST(RandomWalkBias, IsTheLimitOfALongTimeConstant) {
  const BiasStep walk = random_walk_step({0.5, 0.02}), slow = bias_step({0.5, 1e12, 0.02});
  EXPECT_NEAR(walk.variance_m2ps4, slow.variance_m2ps4, 1e-14);
  EXPECT_EQ(walk.phi, 1.0);
  EXPECT_EQ(walk.settled, 0.0);
}

}  // namespace
}  // namespace proofmass::estimate::discretisation_test
