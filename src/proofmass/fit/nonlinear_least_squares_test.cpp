#include "proofmass/fit/nonlinear_least_squares.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/fit/curve.hpp"

namespace proofmass::fit::nonlinear_least_squares_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// r = A p − y.
LeastSquaresProblem linear_problem(const Eigen::MatrixXd& A, const Eigen::VectorXd& y) {
  return {.residuals =
              [=](View<double> p, std::span<double> r) {
                Eigen::VectorXd::Map(r.data(), A.rows()) =
                    A * Eigen::VectorXd::Map(p.data(), A.cols()) - y;
              },
          .residual_count = static_cast<std::size_t>(A.rows()),
          .start = std::vector<double>(static_cast<std::size_t>(A.cols()), 0.0)};
}

struct LinearCase {
  Eigen::MatrixXd A = Eigen::MatrixXd(30, 3);
  Eigen::VectorXd y = Eigen::VectorXd(30);
};

// A parabola with columns of very different lengths.
LinearCase parabola() {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  LinearCase set;
  for (Eigen::Index k = 0; k < 30; ++k) {
    const double t = 10.0 * static_cast<double>(k);
    set.A.row(k) << 1.0, t, t * t;
    set.y(k) = 3.0 - 0.2 * t + 1e-3 * t * t + normal(bits);
  }
  return set;
}

TEST(LeastSquares, OfALinearProblemAreTheNormalEquations) {
  const auto [A, y] = parabola();
  const LeastSquaresFit fit = fit_least_squares(linear_problem(A, y)).value();
  const Eigen::MatrixXd inverse =
      (A.transpose() * A).eval().llt().solve(Eigen::MatrixXd::Identity(3, 3));
  const Eigen::VectorXd p = inverse * (A.transpose() * y);
  const double rss = (A * p - y).squaredNorm();
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.dof, 27U);
  EXPECT_NEAR(fit.rss / rss, 1.0, 1e-12);
  EXPECT_NEAR(fit.residual_std, std::sqrt(rss / 27.0), 1e-12);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(fit.parameters[i] / p(row), 1.0, 1e-10);
    EXPECT_NEAR(fit.std[i], std::sqrt(fit.covariance(row, row)), 1e-15);
    EXPECT_FALSE(fit.at_bound[i]);
  }
  EXPECT_TRUE(fit.covariance.isApprox(inverse * rss / 27.0, 1e-9));
  EXPECT_GT(fit.condition, 1.0);
}

TEST(LeastSquares, OfResidualsInTheirOwnStdTakeTheVarianceAsOne) {
  const auto [A, y] = parabola();
  const auto scaled = fit_least_squares(linear_problem(A, y)).value();
  const auto unit = fit_least_squares(linear_problem(A, y), {.unit_variance = true}).value();
  const double variance = scaled.residual_std * scaled.residual_std;
  EXPECT_TRUE(scaled.covariance.isApprox(unit.covariance * variance, 1e-12));
}

struct Published {
  std::vector<double> x, y;
  CurveModel model;
  std::vector<std::vector<double>> starts;
  std::vector<double> certified, certified_std;
  double rss;
};

Published misra1a() {
  return {.x = {77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1,
                689.1, 760.0},
          .y = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40,
                75.47, 81.78},
          .model = [](double x, View<double> b) { return b[0] * (1.0 - std::exp(-b[1] * x)); },
          .starts = {{500.0, 1e-4}, {250.0, 5e-4}},
          .certified = {2.3894212918e2, 5.5015643181e-4},
          .certified_std = {2.7070075241, 7.2668688436e-6},
          .rss = 1.2455138894e-1};
}

// From its first start, plain descent leads to where the exponential vanishes.
Published boxbod() {
  Published set = misra1a();
  set.x = {1.0, 2.0, 3.0, 5.0, 7.0, 10.0};
  set.y = {109.0, 149.0, 149.0, 191.0, 213.0, 224.0};
  set.starts = {{1.0, 1.0}, {100.0, 0.75}};
  set.certified = {2.1380940889e2, 5.4723748542e-1};
  set.certified_std = {1.2354515176e1, 1.0455993237e-1};
  set.rss = 1.1680088766e3;
  return set;
}

// Its first start is 200 orders of magnitude too high.
Published mgh10() {
  Published set{
      .x = {},
      .y = {34780.0, 28610.0, 23650.0, 19630.0, 16370.0, 13720.0, 11540.0, 9744.0, 8261.0, 7030.0,
            6005.0, 5147.0, 4427.0, 3820.0, 3307.0, 2872.0},
      .model = [](double x, View<double> b) { return b[0] * std::exp(b[1] / (x + b[2])); },
      .starts = {{2.0, 4e5, 25000.0}, {0.02, 4000.0, 250.0}},
      .certified = {5.6096364710e-3, 6.1813463463e3, 3.4522363462e2},
      .certified_std = {1.5687892471e-4, 2.3309021107e1, 7.8486103508e-1},
      .rss = 8.7945855171e1};
  for (int k = 0; k < 16; ++k) set.x.push_back(50.0 + 5.0 * k);
  return set;
}

// Two exponentials; both are far too short at the first start.
Published mgh17() {
  Published set{
      .x = {},
      .y = {0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751,
            0.718, 0.685, 0.658, 0.628, 0.603, 0.580, 0.558, 0.538, 0.522, 0.506, 0.490,
            0.478, 0.467, 0.457, 0.448, 0.438, 0.431, 0.424, 0.420, 0.414, 0.411, 0.406},
      .model =
          [](double x, View<double> b) {
            return b[0] + b[1] * std::exp(-x * b[3]) + b[2] * std::exp(-x * b[4]);
          },
      .starts = {{50.0, 150.0, -100.0, 1.0, 2.0}, {0.5, 1.5, -1.0, 0.01, 0.02}},
      .certified = {3.7541005211e-1, 1.9358469127, -1.4646871366, 1.2867534640e-2, 2.2122699662e-2},
      .certified_std = {2.0723153551e-3, 2.2031669222e-1, 2.2175707739e-1, 4.4861358114e-4,
                        8.9471996575e-4},
      .rss = 5.4648946975e-5};
  for (int k = 0; k < 33; ++k) set.x.push_back(10.0 * k);
  return set;
}

// A quotient that is nearly linear in each parameter, from a start a hundred times too high.
Published mgh09() {
  return {
      .x = {4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625},
      .y = {0.1957, 0.1947, 0.1735, 0.16, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246},
      .model = [](double x,
                  View<double> b) { return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]); },
      .starts = {{25.0, 39.0, 41.5, 39.0}, {0.25, 0.39, 0.415, 0.39}},
      .certified = {1.9280693458e-1, 1.9128232873e-1, 1.2305650693e-1, 1.3606233068e-1},
      .certified_std = {1.1435312227e-2, 1.9633220911e-1, 8.0842031232e-2, 9.0025542308e-2},
      .rss = 3.0750560385e-4};
}

Published rat43() {
  Published set{.x = {},
                .y = {16.08, 33.83, 65.80, 97.20, 191.55, 326.20, 386.87, 520.53, 590.03, 651.92,
                      724.93, 699.56, 689.96, 637.56, 717.41},
                .model =
                    [](double x, View<double> b) {
                      return b[0] / std::pow(1.0 + std::exp(b[1] - b[2] * x), 1.0 / b[3]);
                    },
                .starts = {{100.0, 10.0, 1.0, 1.0}, {700.0, 5.0, 0.75, 1.3}},
                .certified = {6.9964151270e2, 5.2771253025, 7.5962938329e-1, 1.2792483859},
                .certified_std = {1.6302297817e1, 2.0828735829, 1.9566123451e-1, 6.8761936385e-1},
                .rss = 8.7864049080e3};
  for (int k = 1; k <= 15; ++k) set.x.push_back(k);
  return set;
}

class NistSet : public testing::TestWithParam<Published (*)()> {};

TEST_P(NistSet, FromBothStartsHasItsCertifiedFit) {
  const Published set = GetParam()();
  for (const std::vector<double>& start : set.starts) {
    const LeastSquaresFit fit = fit_curve(set.x, set.y, set.model, start).value();
    EXPECT_TRUE(fit.converged);
    EXPECT_NEAR(fit.rss / set.rss, 1.0, 1e-9);
    for (std::size_t j = 0; j < set.certified.size(); ++j) {
      EXPECT_NEAR(fit.parameters[j] / set.certified[j], 1.0, 1e-9) << j;
      EXPECT_NEAR(fit.std[j] / set.certified_std[j], 1.0, 1e-9) << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Published,
                         NistSet,
                         testing::Values(misra1a, boxbod, mgh09, mgh10, mgh17, rat43));

LeastSquaresProblem misra1a_problem() {
  const Published set = misra1a();
  return {.residuals =
              [=](View<double> b, std::span<double> r) {
                for (std::size_t k = 0; k < r.size(); ++k) r[k] = set.model(set.x[k], b) - set.y[k];
              },
          .residual_count = set.x.size(),
          .start = set.starts[0]};
}

TEST(LeastSquares, WithTheExactJacobianAreTheSame) {
  LeastSquaresProblem problem = misra1a_problem();
  const LeastSquaresFit numerical = fit_least_squares(problem).value();
  problem.jacobian = [x = misra1a().x](View<double> b, Eigen::Ref<Eigen::MatrixXd> J) {
    for (Eigen::Index k = 0; k < J.rows(); ++k) {
      const double at = x[static_cast<std::size_t>(k)];
      J.row(k) << 1.0 - std::exp(-b[1] * at), b[0] * at * std::exp(-b[1] * at);
    }
  };
  const LeastSquaresFit exact = fit_least_squares(problem).value();
  EXPECT_NEAR(numerical.parameters[0] / exact.parameters[0], 1.0, 1e-10);
  EXPECT_TRUE(numerical.covariance.isApprox(exact.covariance, 1e-9));
}

TEST(LeastSquares, HoldAParameterAtTheBoundItPressesAgainst) {
  LeastSquaresProblem problem = misra1a_problem();
  problem.start = {210.0, 5e-4};
  problem.upper = {220.0, infinity};
  problem.lower = {-infinity, 0.0};
  const LeastSquaresFit fit = fit_least_squares(problem).value();
  EXPECT_EQ(fit.parameters[0], 220.0);
  EXPECT_TRUE(fit.at_bound[0]);
  EXPECT_FALSE(fit.at_bound[1]);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.dof, 12U);
  EXPECT_EQ(fit.std[0], 0.0);
  EXPECT_EQ(fit.covariance(0, 1), 0.0);

  problem.start = {220.0, 1e-3};
  problem.lower = {220.0, 0.0};
  const LeastSquaresFit held = fit_least_squares(problem).value();
  EXPECT_NEAR(fit.parameters[1] / held.parameters[1], 1.0, 1e-10);
  EXPECT_NEAR(fit.rss / held.rss, 1.0, 1e-10);
  EXPECT_EQ(held.dof, 13U);
  EXPECT_NEAR(fit.std[1] / held.std[1], std::sqrt(13.0 / 12.0), 1e-9);
}

TEST(LeastSquares, LeaveABoundThatTheyBeginAt) {
  LeastSquaresProblem problem = misra1a_problem();
  problem.start = {300.0, 1e-4};
  problem.upper = {300.0, 1e-3};
  problem.lower = {1.0, 1e-4};
  const LeastSquaresFit fit = fit_least_squares(problem).value();
  EXPECT_NEAR(fit.parameters[0], misra1a().certified[0], 1e-7);
  EXPECT_FALSE(fit.at_bound[0]);
}

TEST(LeastSquares, TurnBackWhereTheResidualsAreNotFinite) {
  // Square root of a value that becomes negative between the start and the minimum.
  LeastSquaresProblem problem{.residuals =
                                  [](View<double> p, std::span<double> r) {
                                    r[0] = std::sqrt(p[0]) - 0.1;
                                    r[1] = 0.1 * (std::log(p[0]) - std::log(0.01));
                                  },
                              .residual_count = 2,
                              .start = {400.0}};
  testing::internal::CaptureStderr();
  const LeastSquaresFit fit = fit_least_squares(problem).value();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.parameters[0], 0.01, 1e-10);
}

TEST(LeastSquares, OfTwoColumnsAlikeSaySo) {
  auto [A, y] = parabola();
  A.col(2) = 2.0 * A.col(1);
  const LeastSquaresFit fit = fit_least_squares(linear_problem(A, y)).value();
  EXPECT_EQ(fit.condition, infinity);
  EXPECT_EQ(fit.std[1], infinity);
  EXPECT_EQ(fit.std[2], infinity);
  EXPECT_TRUE(std::isfinite(fit.std[0]));
  const LeastSquaresFit line = fit_least_squares(linear_problem(A.leftCols(2), y)).value();
  EXPECT_NEAR(fit.rss / line.rss, 1.0, 1e-10);
  EXPECT_NEAR(fit.parameters[1] + 2.0 * fit.parameters[2], line.parameters[1], 1e-8);
}

TEST(LeastSquares, OfAParameterThatDoesNothingSaySo) {
  const auto fit = fit_least_squares({.residuals =
                                          [](View<double> p, std::span<double> r) {
                                            for (double& value : r) value = p[0] - 3.0;
                                          },
                                      .residual_count = 5,
                                      .start = {1.0, 7.0}})
                       .value();
  EXPECT_NEAR(fit.parameters[0], 3.0, 1e-14);
  EXPECT_EQ(fit.std[1], infinity);
  EXPECT_EQ(fit.condition, infinity);
}

TEST(LeastSquares, CutShortAreNotConverged) {
  const auto fit =
      fit_least_squares(misra1a_problem(), {.search_again = false, .max_iterations = 1}).value();
  EXPECT_FALSE(fit.converged);
}

TEST(LeastSquares, WithAsManyParametersAsResidualsHaveNoResidualStd) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(2, 2);
  const auto fit = fit_least_squares(linear_problem(A, Eigen::Vector2d(4.0, 5.0))).value();
  EXPECT_EQ(fit.dof, 0U);
  EXPECT_TRUE(std::isnan(fit.residual_std));
  EXPECT_NEAR(fit.parameters[1], 5.0, 1e-12);
  EXPECT_TRUE(fit.converged);
}

Errc refused(const LeastSquaresProblem& problem, const LeastSquaresOptions& options = {}) {
  const auto fit = fit_least_squares(problem, options);
  EXPECT_FALSE(fit.has_value());
  return fit ? Errc::corrupt : fit.error().code;
}

TEST(LeastSquares, SayWhyTheyCannot) {
  const LeastSquaresProblem good = misra1a_problem();
  LeastSquaresProblem problem = good;
  problem.start = {};
  EXPECT_EQ(refused(problem), Errc::invalid_argument);
  problem = good;
  problem.residual_count = 1;
  EXPECT_EQ(refused(problem), Errc::too_few_samples);
  problem = good;
  problem.lower = {0.0};
  EXPECT_EQ(refused(problem), Errc::invalid_argument);
  problem.lower = {0.0, 1.0};
  EXPECT_EQ(refused(problem), Errc::invalid_argument);
  problem.lower = {0.0, 0.0};
  problem.upper = {1e3, -1.0};
  EXPECT_EQ(refused(problem), Errc::invalid_argument);
  problem = good;
  problem.start[1] = nan;
  EXPECT_EQ(refused(problem), Errc::not_finite);
  problem.start[1] = -10.0;  // exp(7600)
  EXPECT_EQ(refused(problem), Errc::not_finite);
  EXPECT_EQ(refused(good, {.max_iterations = 0}), Errc::invalid_argument);
  EXPECT_EQ(refused(good, {.scale = {1.0}}), Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::fit::nonlinear_least_squares_test
