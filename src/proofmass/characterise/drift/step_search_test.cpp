#include "proofmass/characterise/drift/step_search.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/characterise/drift/drift_test_support.hpp"
#include "proofmass/characterise/drift/fit_at_shape.hpp"
#include "proofmass/characterise/drift/noise.hpp"

namespace proofmass::characterise::step_search_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Series;

constexpr std::size_t n = 96;
constexpr Sampling sampling{1.0, 1};

Series noise(unsigned seed) {
  return test::sum_of({test::white(1.0, 1.0, n, seed), test::random_walk(0.1, 1.0, n, seed + 1)});
}

VectorXd density_of(const DriftEvidence& evidence) {
  return NoiseChoice(evidence).base().P * Eigen::Vector2d(1.0, 0.01);
}

/// Twice the increase in log-likelihood due to a step, by fitting with and without it.
double refitted(const DriftEvidence& evidence,
                const MatrixXd& fitted,
                const VectorXd& density,
                std::size_t block) {
  const VectorXd z = evidence.ordinates().tail(evidence.blocks() - 1);
  MatrixXd with(fitted.rows(), fitted.cols() + 1);
  with << fitted, evidence.step(block).tail(fitted.rows());
  const VectorXd one = VectorXd::Ones(1);
  return 2.0 * (evaluate_ordinates(z, density, {with, {}}, one).log_likelihood -
                evaluate_ordinates(z, density, {fitted, {}}, one).log_likelihood);
}

TEST(StepSearch, FindsThePlaceOfAStepExactly) {
  for (const std::size_t place : {2UL, 3UL, 40UL, 93UL, 94UL}) {
    const DriftEvidence evidence =
        test::evidence_of(test::sum_of({noise(1), test::step_at(place, 15.0, n)}), sampling);
    EXPECT_EQ(find_step(evidence, MatrixXd(n - 1, 0), density_of(evidence)).block, place);
  }
}

TEST(StepSearch, GainsWhatARefitGainsAtTheBestOfAllPlaces) {
  Series samples = test::sum_of({noise(3), test::step_at(60, 4.0, n)});
  for (const std::size_t k : {20UL, 21UL, 59UL})
    samples[k] = std::numeric_limits<double>::quiet_NaN();
  const DriftEvidence evidence = test::evidence_of(samples, sampling);
  const VectorXd density = density_of(evidence);
  const MatrixXd fitted =
      linear_columns(evidence, {DriftShape::exponential_and_line, {std::log(20.0)}, {}});
  const FoundStep found = find_step(evidence, fitted, density);
  EXPECT_NEAR(found.gain, refitted(evidence, fitted, density, found.block), 1e-6);
  for (std::size_t block = 2; block <= n - 2; ++block)
    EXPECT_GE(found.gain, refitted(evidence, fitted, density, block) - 1e-6) << block;
}

TEST(StepSearch, HasNoGainForAFittedStep) {
  const DriftEvidence evidence =
      test::evidence_of(test::sum_of({noise(5), test::step_at(60, 15.0, n)}), sampling);
  const VectorXd density = density_of(evidence);
  const MatrixXd fitted = linear_columns(evidence, {DriftShape::steps, {}, {60}});
  const FoundStep next = find_step(evidence, fitted, density);
  EXPECT_NE(next.block, 60U);
  EXPECT_LT(next.gain, 20.0);
}

TEST(StepSearch, FindsTheSecondOfTwoBesideTheFirst) {
  const DriftEvidence evidence = test::evidence_of(
      test::sum_of({noise(7), test::step_at(30, 15.0, n), test::step_at(70, -15.0, n)}), sampling);
  const MatrixXd fitted = linear_columns(evidence, {DriftShape::steps, {}, {30}});
  EXPECT_EQ(find_step(evidence, fitted, density_of(evidence)).block, 70U);
}

}  // namespace
}  // namespace proofmass::characterise::step_search_test
