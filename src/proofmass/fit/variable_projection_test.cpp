#include "proofmass/fit/variable_projection.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/fit/curve.hpp"

namespace proofmass::fit::variable_projection_test {
namespace {

using Index = Eigen::Index;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A warm-up: 2 + 0.01 t + 5 exp(−t/8) + noise, t = 0 … 59.9.
struct WarmUp {
  std::vector<double> t, y;
  Eigen::MatrixXd line = Eigen::MatrixXd(600, 2);
};

WarmUp warm_up() {
  std::mt19937_64 bits(11);
  std::normal_distribution<double> normal;
  WarmUp set;
  for (Index k = 0; k < 600; ++k) {
    const double t = 0.1 * static_cast<double>(k);
    set.t.push_back(t);
    set.y.push_back(2.0 + 0.01 * t + 5.0 * std::exp(-t / 8.0) + 0.3 * normal(bits));
    set.line.row(k) << 1.0, t;
  }
  return set;
}

Basis decays(const std::vector<double>& t) {
  return [t](View<double> alpha, Eigen::Ref<Eigen::MatrixXd> columns) {
    for (Index k = 0; k < columns.rows(); ++k)
      for (Index j = 0; j < columns.cols(); ++j)
        columns(k, j) =
            std::exp(-t[static_cast<std::size_t>(k)] / alpha[static_cast<std::size_t>(j)]);
  };
}

SeparableProblem separable(const WarmUp& set) {
  return {.basis = decays(set.t),
          .varying_columns = 1,
          .start = {20.0},
          .constant = factor_columns(set.line)};
}

// The same fit over all four parameters, in the order [T; offset, slope, amplitude].
LeastSquaresFit full_fit(const WarmUp& set, const LeastSquaresOptions& options = {}) {
  return fit_curve(
             set.t, set.y,
             [](double t, View<double> p) { return p[1] + p[2] * t + p[3] * std::exp(-t / p[0]); },
             std::vector{20.0, 1.0, 0.0, 1.0}, {.solver = options})
      .value();
}

void expect_same(const SeparableFit& fit, const LeastSquaresFit& full) {
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.alpha[0] / full.parameters[0], 1.0, 1e-9);
  for (Index j = 0; j < fit.coefficients.size(); ++j)
    EXPECT_NEAR(fit.coefficients(j) / full.parameters[static_cast<std::size_t>(j) + 1], 1.0, 1e-8);
  EXPECT_TRUE(fit.covariance.isApprox(full.covariance, 1e-8));
  EXPECT_NEAR(fit.rss / full.rss, 1.0, 1e-12);
  EXPECT_NEAR(fit.residual_std / full.residual_std, 1.0, 1e-12);
  EXPECT_EQ(fit.dof, static_cast<Index>(full.dof));
}

TEST(VariableProjection, IsTheFullNonlinearFit) {
  const WarmUp set = warm_up();
  expect_same(fit_separable(set.y, separable(set)).value(), full_fit(set));
}

TEST(VariableProjection, KnowsTheVarianceIfTold) {
  const WarmUp set = warm_up();
  expect_same(fit_separable(set.y, separable(set), {.unit_variance = true}).value(),
              full_fit(set, {.unit_variance = true}));
}

TEST(VariableProjection, DoesNotCareWhichColumnsAreCalledConstant) {
  const WarmUp set = warm_up();
  const Basis decay = decays(set.t);
  const SeparableProblem all{.basis =
                                 [&](View<double> alpha, Eigen::Ref<Eigen::MatrixXd> columns) {
                                   columns.leftCols(2) = set.line;
                                   decay(alpha, columns.rightCols(1));
                                 },
                             .varying_columns = 3,
                             .start = {20.0}};
  const SeparableFit fit = fit_separable(set.y, all).value();
  expect_same(fit, full_fit(set));
  const SeparableFit other = fit_separable(set.y, separable(set)).value();
  EXPECT_NEAR(fit.basis_condition / other.basis_condition, 1.0, 1e-9);
  EXPECT_GT(fit.basis_condition, 1.0);
}

TEST(VariableProjection, SeparatesTwoDecays) {
  WarmUp set = warm_up();
  for (std::size_t k = 0; k < set.t.size(); ++k)
    set.y[k] -= 3.0 * std::exp(-set.t[k] / 2.0) + 0.01 * set.t[k];
  const SeparableProblem problem{.basis = decays(set.t),
                                 .varying_columns = 2,
                                 .start = {1.0, 20.0},
                                 .lower = {0.1, 0.1},
                                 .upper = {100.0, 100.0},
                                 .constant = factor_columns(set.line.leftCols(1))};
  const SeparableFit fit = fit_separable(set.y, problem).value();
  const LeastSquaresFit full =
      fit_curve(
          set.t, set.y,
          [](double t, View<double> p) {
            return p[2] + p[3] * std::exp(-t / p[0]) + p[4] * std::exp(-t / p[1]);
          },
          std::vector{2.0, 8.0, 2.0, -3.0, 5.0})
          .value();
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.alpha[0] / full.parameters[0], 1.0, 1e-8);
  EXPECT_NEAR(fit.alpha[1] / full.parameters[1], 1.0, 1e-8);
  EXPECT_TRUE(fit.covariance.isApprox(full.covariance, 1e-7));
}

TEST(VariableProjection, HoldsAlphaAtItsBound) {
  const WarmUp set = warm_up();
  SeparableProblem problem = separable(set);
  problem.lower = {10.0};
  problem.upper = {100.0};
  const SeparableFit fit = fit_separable(set.y, problem).value();
  EXPECT_EQ(fit.alpha[0], 10.0);
  EXPECT_TRUE(fit.at_bound[0]);
  EXPECT_EQ(fit.covariance(0, 0), 0.0);
  Eigen::MatrixXd Phi(600, 3);
  Eigen::MatrixXd decay(600, 1);
  problem.basis(fit.alpha, decay);
  Phi << set.line, decay;
  const Eigen::MatrixXd information = Phi.transpose() * Phi;
  const Eigen::MatrixXd product =
      fit.covariance.bottomRightCorner(3, 3) * information / std::pow(fit.residual_std, 2);
  EXPECT_TRUE(product.isIdentity(1e-9));
  const Eigen::VectorXd y = Eigen::VectorXd::Map(set.y.data(), 600);
  EXPECT_TRUE((information * fit.coefficients).isApprox(Phi.transpose() * y, 1e-10));
}

TEST(VariableProjection, LeavesOutAColumnThatAddsNothing) {
  const WarmUp set = warm_up();
  Eigen::MatrixXd columns(600, 3);
  columns << set.line, set.line.col(0) + set.line.col(1);
  SeparableProblem problem = separable(set);
  problem.constant = factor_columns(columns);
  const SeparableFit fit = fit_separable(set.y, problem).value();
  const SeparableFit plain = fit_separable(set.y, separable(set)).value();
  EXPECT_EQ(fit.basis_condition, infinity);
  EXPECT_EQ(fit.dof, plain.dof);
  EXPECT_NEAR(fit.rss / plain.rss, 1.0, 1e-10);
  EXPECT_NEAR(fit.alpha[0], plain.alpha[0], 1e-8);
  EXPECT_EQ(fit.covariance.diagonal().array().isInf().count(), 1);

  problem.basis = [](View<double>, Eigen::Ref<Eigen::MatrixXd> varying) { varying.setOnes(); };
  const SeparableFit empty = fit_separable(set.y, problem).value();
  EXPECT_EQ(empty.basis_condition, infinity);
  EXPECT_EQ(empty.condition, infinity);
  EXPECT_EQ(empty.covariance(0, 0), infinity);
}

TEST(VariableProjection, SurvivesADecayTooLongToTellFromALine) {
  WarmUp set = warm_up();
  for (std::size_t k = 0; k < set.t.size(); ++k) set.y[k] = 1.0 + 0.1 * set.t[k];
  const auto fit = fit_separable(set.y, separable(set));
  ASSERT_TRUE(fit.has_value());
  EXPECT_LT(fit->rss, 1e-6);
}

TEST(VariableProjection, TurnsBackWhereTheBasisIsNotFinite) {
  const WarmUp set = warm_up();
  SeparableProblem problem = separable(set);
  problem.basis = [decay = problem.basis](View<double> alpha, Eigen::Ref<Eigen::MatrixXd> columns) {
    decay(alpha, columns);
    if (alpha[0] < 5.0) columns.setConstant(nan);
  };
  EXPECT_NEAR(fit_separable(set.y, problem).value().alpha[0],
              fit_separable(set.y, separable(set)).value().alpha[0], 1e-8);
  problem.start = {4.0};
  EXPECT_EQ(fit_separable(set.y, problem).error().code, Errc::not_finite);
}

TEST(VariableProjection, SaysWhyItCannot) {
  const WarmUp set = warm_up();
  SeparableProblem problem = separable(set);
  const std::vector<double> shorter(set.y.begin(), set.y.end() - 1);
  EXPECT_EQ(fit_separable(shorter, problem).error().code, Errc::invalid_argument);
  std::vector<double> y = set.y;
  y[3] = nan;
  EXPECT_EQ(fit_separable(y, problem).error().code, Errc::not_finite);
  problem.constant = factor_columns(set.line.topRows(3));
  EXPECT_EQ(fit_separable(std::vector{1.0, 2.0, 3.0}, problem).error().code, Errc::too_few_samples);
  problem = separable(set);
  problem.varying_columns = 0;
  EXPECT_EQ(fit_separable(set.y, problem).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::fit::variable_projection_test
