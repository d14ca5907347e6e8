#include "proofmass/characterise/noise/ordinate_likelihood.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "proofmass/characterise/drift/drift_test_support.hpp"
#include "proofmass/characterise/drift/fit_at_shape.hpp"
#include "proofmass/characterise/drift/noise.hpp"

namespace proofmass::characterise::ordinate_likelihood_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Series;

constexpr std::size_t n = 96;
constexpr double rate_hz = 0.5, h = 2.0;

VectorXd strengths(double N, double K) {
  return Eigen::Vector2d(N * N, K * K);
}

/// Warm-up, white noise of density 1 and a random walk of 0.3 per √s.
Series record(unsigned seed) {
  return test::sum_of({test::warm_up(4.0, 30.0, rate_hz, n), test::white(1.0, rate_hz, n, seed),
                       test::random_walk(0.3, rate_hz, n, seed + 1)});
}

Series without(Series samples, const std::vector<std::size_t>& blocks) {
  for (const std::size_t k : blocks) samples[k] = std::numeric_limits<double>::quiet_NaN();
  return samples;
}

/// All gaps of 1 to 7 blocks that begin at a multiple of 12: 28 blocks.
std::vector<std::size_t> many_blocks() {
  std::vector<std::size_t> blocks;
  for (std::size_t gap = 0; gap < n / 12; ++gap)
    for (std::size_t k = 0; k < std::min<std::size_t>(gap + 1, 7); ++k)
      blocks.push_back(12 * gap + k);
  return blocks;
}

/// The same record in two forms: as ordinates, with each sample a block, and dense.
struct Both {
  DriftEvidence evidence;
  NoiseColumns noise;
  OrdinateMeans means;
  VectorXd z;
  std::vector<Index> present;
  VectorXd y;
  MatrixXd X;

  explicit Both(const Series& samples)
      : evidence(test::evidence_of(samples, {rate_hz, 1})), noise(NoiseChoice(evidence).base()) {
    const ShapeAt shape{DriftShape::exponential_and_line, {std::log(30.0)}, {}};
    means.fitted = means.adjusting = linear_columns(evidence, shape);
    means.impulses = evidence.missing();
    z = evidence.ordinates().tail(evidence.blocks() - 1);
    for (std::size_t k = 0; k < n; ++k)
      if (!std::isnan(samples[k])) present.push_back(static_cast<Index>(k));
    y.resize(static_cast<Index>(present.size()));
    X.resize(y.size(), 3);
    const Series rise = evidence.series(evidence.rise(30.0));
    for (Index i = 0; i < y.size(); ++i) {
      const auto k = static_cast<std::size_t>(present[static_cast<std::size_t>(i)]);
      y(i) = samples[k];
      X.row(i) << rise[k], (static_cast<double>(k) + 0.5) / static_cast<double>(n), 1.0;
    }
  }

  [[nodiscard]] OrdinateFit at(double N, double K) const {
    return evaluate_ordinates(z, noise.P, means, strengths(N, K));
  }
  [[nodiscard]] test::DenseFit dense(double N, double K) const {
    const MatrixXd all = test::white_and_walk(N, K, h, static_cast<Index>(n));
    return test::fit_dense(y, {all(present, present), X});
  }
};

void expect_same_likelihood(const Both& both) {
  const double reference = both.at(1.0, 0.3).log_likelihood;
  const test::DenseFit dense = both.dense(1.0, 0.3);
  for (const double N : {0.4, 1.0, 2.5})
    for (const double K : {0.01, 0.3, 2.0})
      EXPECT_NEAR(both.at(N, K).log_likelihood - reference,
                  both.dense(N, K).restricted_log_likelihood - dense.restricted_log_likelihood,
                  1e-6)
          << "N " << N << ", K " << K;
}

void expect_same_least_squares(const Both& both) {
  const OrdinateFit fit = both.at(0.8, 0.4);
  const test::DenseFit dense = both.dense(0.8, 0.4);
  // Exponential and line; the level is not among the ordinates.
  EXPECT_TRUE(fit.coefficients.head(2).isApprox(dense.coefficients.head(2), 1e-8));
  EXPECT_TRUE(
      fit.covariance.topLeftCorner(2, 2).isApprox(dense.covariance.topLeftCorner(2, 2), 1e-8));
}

TEST(OrdinateLikelihood, OfWhiteNoiseIsTheMeanSquareOfTheResidual) {
  const Both both(record(1));
  const MatrixXd P = MatrixXd::Ones(both.z.size(), 1);
  const MatrixXd X = both.means.fitted;
  const VectorXd b = positive_inverse(X.transpose() * X) * (X.transpose() * both.z);
  const double squares = (both.z - X * b).squaredNorm();
  const double rows = static_cast<double>(n) - 1.0;
  const OrdinateFit plain = fit_ordinates(both.z, P, {X, {}});
  EXPECT_NEAR(plain.strength(0), squares / rows, 1e-9 * squares);
  EXPECT_TRUE(plain.coefficients.isApprox(b, 1e-9));
  EXPECT_NEAR(plain.log_likelihood, -0.5 * rows * (std::log(squares / rows) + 1.0), 1e-9);
  // Within the tolerance of the scoring, which stops at 1e-6 in the log-likelihood.
  const double restricted = squares / (rows - 2.0);
  EXPECT_NEAR(fit_ordinates(both.z, P, {X, X}).strength(0), restricted, 1e-5 * restricted);
}

TEST(OrdinateLikelihood, WithoutAFitIsThatOfTheOrdinates) {
  const Both both(record(2));
  const OrdinateFit fit = evaluate_ordinates(both.z, both.noise.P, {}, strengths(1.0, 0.3));
  double wanted = 0.0;
  for (Index k = 0; k < both.z.size(); ++k) {
    const double S = both.noise.P(k, 0) + 0.09 * both.noise.P(k, 1);
    wanted -= 0.5 * (std::log(S) + both.z(k) * both.z(k) / S);
  }
  EXPECT_NEAR(fit.log_likelihood, wanted, 1e-9);
  EXPECT_EQ(fit.coefficients.size(), 0);
}

TEST(OrdinateLikelihood, IsTheRestrictedLikelihoodOfTheDenseModel) {
  const Both both(record(3));
  expect_same_likelihood(both);
  expect_same_least_squares(both);
}

TEST(OrdinateLikelihood, LeavesMissingBlocksOutByTheirColumns) {
  for (const auto& blocks : {std::vector<std::size_t>{5, 40, 41, 42, 95}, many_blocks()}) {
    const Both both(without(record(4), blocks));
    ASSERT_EQ(both.means.impulses.size(), blocks.size());
    expect_same_likelihood(both);
    expect_same_least_squares(both);
  }
}

TEST(OrdinateLikelihood, GramOfImpulsesIsThatOfTheirColumns) {
  const Both both(without(record(4), many_blocks()));
  const MatrixXd& X = both.means.fitted;
  const VectorXd w = (both.noise.P * strengths(1.0, 0.3)).cwiseInverse();
  const MatrixXd wanted = X.transpose() * w.asDiagonal() * X;
  EXPECT_LT((GramOfColumns(both.means.impulses, w).of(X) - wanted).cwiseAbs().maxCoeff(),
            1e-13 * wanted.maxCoeff());
}

// The scoring stops at about 1e-6 in the log-likelihood.
TEST(OrdinateLikelihood, FindsTheStrengthsThatAreBestOnADenseGrid) {
  for (const unsigned seed : {5U, 7U, 9U}) {
    const Both both(record(seed));
    const OrdinateFit fit = fit_ordinates(both.z, both.noise.P, both.means);
    const double N = std::sqrt(fit.strength(0)), K = std::sqrt(fit.strength(1));
    ASSERT_GT(N, 0.0);
    ASSERT_GT(K, 0.0);
    const double best = both.dense(N, K).restricted_log_likelihood;
    for (const double of_N : {0.5, 0.9, 0.99, 1.0, 1.01, 1.1, 2.0})
      for (const double of_K : {0.5, 0.9, 0.99, 1.0, 1.01, 1.1, 2.0})
        EXPECT_LE(both.dense(of_N * N, of_K * K).restricted_log_likelihood, best + 1e-5);
  }
}

TEST(OrdinateLikelihood, ComesToTheSamePlaceFromAnywhere) {
  const Both both(record(11));
  const double best = fit_ordinates(both.z, both.noise.P, both.means).log_likelihood;
  for (const double N : {0.01, 1.0, 30.0})
    for (const double K : {0.01, 1.0, 30.0})
      EXPECT_NEAR(fit_ordinates(both.z, both.noise.P, both.means, strengths(N, K)).log_likelihood,
                  best, 1e-4);
}

TEST(OrdinateLikelihood, LeavesAnAbsentTermAtZero) {
  // Alternating signs have less power at low frequencies than white noise.
  Series samples = test::normals(n, 13);
  for (std::size_t k = n; --k > 0;) samples[k] -= samples[k - 1];
  const Both both(samples);
  EXPECT_EQ(fit_ordinates(both.z, both.noise.P, both.means).strength(1), 0.0);
}

// The score by differences of the likelihood, and the information on one strength given another.
TEST(PromisedGain, IsTheScoreTestOfOneMoreColumn) {
  const Both both(record(17));
  const MatrixXd white = both.noise.P.col(0);
  const VectorXd walk = both.noise.P.col(1);
  const OrdinateFit fit = fit_ordinates(both.z, white, both.means);
  const double least = 1e-7;
  const double score =
      (evaluate_ordinates(both.z, both.noise.P, both.means, Eigen::Vector2d(fit.strength(0), least))
           .log_likelihood -
       fit.log_likelihood) /
      least;
  ASSERT_GT(score, 0.0);
  const auto information = [&](const VectorXd& one, const VectorXd& other) {
    return 0.5 * (one.array() * other.array() / fit.density.array().square()).sum();
  };
  const double shared = information(walk, white);
  const double own = information(walk, walk) - shared * shared / information(white, white);
  const double promised = promised_gain(both.z, white, both.means, fit, {&walk, 1});
  EXPECT_NEAR(promised, score * score / own, 1e-3 * promised);
}

TEST(PromisedGain, IsZeroForANegativeScore) {
  Series samples = test::normals(n, 13);
  for (std::size_t k = n; --k > 0;) samples[k] -= samples[k - 1];
  const Both both(samples);
  const MatrixXd white = both.noise.P.col(0);
  const OrdinateFit fit = fit_ordinates(both.z, white, both.means);
  const VectorXd walk = both.noise.P.col(1);
  EXPECT_EQ(promised_gain(both.z, white, both.means, fit, {&walk, 1}), 0.0);
}

// No strength shares the information: (½ Σ c (p − S)/S²)² / (½ Σ c²/S²).
TEST(PromisedGain, BesideNoStrengthIsThatOfTheColumnAlone) {
  const Both both(record(14));
  const MatrixXd white = both.noise.P.col(0);
  const OrdinateFit none = evaluate_ordinates(both.z, white, {}, VectorXd::Zero(1));
  const VectorXd c = both.noise.P.col(1);
  const Eigen::ArrayXd S = none.density.array(), p = both.z.array().square();
  const double score = 0.5 * (c.array() * (p - S) / S.square()).sum();
  const double wanted = score * score / (0.5 * (c.array() / S).square().sum());
  EXPECT_NEAR(promised_gain(both.z, white, {}, none, {&c, 1}), wanted, 1e-9 * wanted);
}

TEST(OrdinateLikelihood, ScalesWithTheData) {
  const Both both(record(15));
  const OrdinateFit fit = fit_ordinates(both.z, both.noise.P, both.means);
  for (const double factor : {1e-6, 1e6}) {
    const OrdinateFit scaled = fit_ordinates(factor * both.z, both.noise.P, both.means);
    EXPECT_TRUE(scaled.strength.isApprox(factor * factor * fit.strength, 1e-6));
    EXPECT_TRUE(scaled.coefficients.isApprox(factor * fit.coefficients, 1e-6));
  }
}

}  // namespace
}  // namespace proofmass::characterise::ordinate_likelihood_test
