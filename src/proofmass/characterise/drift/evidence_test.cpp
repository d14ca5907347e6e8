#include "proofmass/characterise/drift/evidence.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/characterise/drift/drift_test_support.hpp"
#include "proofmass/signal/fourier.hpp"

namespace proofmass::characterise::drift_evidence_test {
namespace {

using Eigen::VectorXd;
using test::Series;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t n = 96;
constexpr Sampling blocks_of_three{2.0, 3};
constexpr double h = 1.5;

DriftEvidence made(const Series& means, double start_s = 0.0) {
  return DriftEvidence::make(means, blocks_of_three, start_s).value();
}

/// √h times the transform of block means, of which the columns are closed forms.
template <class Mean>
VectorXd transform_of(Mean mean_of_block) {
  Series means(n);
  for (std::size_t k = 0; k < n; ++k) means[k] = mean_of_block(k);
  const Series amplitudes = signal::cosine_transform(means);
  return std::sqrt(h) * test::vector_of(amplitudes);
}

void expect_equal(const VectorXd& found, const VectorXd& wanted, double tolerance) {
  ASSERT_EQ(found.size(), wanted.size());
  EXPECT_LT((found - wanted).norm(), tolerance * wanted.norm());
}

/// Mean of 1 − e^(−t/T) over a block, in long double because of cancellation for large T.
double mean_rise(double from_s, double time_constant_s) {
  const auto T = static_cast<long double>(time_constant_s), x = static_cast<long double>(h) / T;
  const long double before = -std::expm1(-static_cast<long double>(from_s) / T);
  // Below 1e-3 by the series of 1 − (1 − e^(−x))/x.
  const long double within = x < 1e-3L ? x / 2 - x * x / 6 + x * x * x / 24 - x * x * x * x / 120
                                       : 1.0L + std::expm1(-x) / x;
  return static_cast<double>(before + (1.0L - before) * within);
}

TEST(DriftEvidence, HasTheRiseOfTheBlockMeansAtAnyTimeConstantAndStart) {
  for (const double start_s : {0.0, 20.0, 400.0}) {
    const DriftEvidence evidence = made(test::normals(n, 1), start_s);
    for (const double T : {0.01, 3.0, 25.0, 144.0, 1440.0, 1e6}) {
      SCOPED_TRACE(testing::Message() << "T " << T << " s, start " << start_s << " s");
      const VectorXd wanted = transform_of(
          [&](std::size_t k) { return mean_rise(start_s + static_cast<double>(k) * h, T); });
      expect_equal(evidence.rise(T), wanted, 1e-10);
    }
  }
}

TEST(DriftEvidence, HasTheDerivativeOfTheRiseByLogTime) {
  const DriftEvidence evidence = made(test::normals(n, 1), 20.0);
  for (const double T : {3.0, 25.0, 1440.0}) {
    // The mean of −(t/T) e^(−t/T), by Simpson's rule.
    const VectorXd wanted = transform_of([&](std::size_t k) {
      constexpr int parts = 64;
      double sum = 0.0;
      for (int i = 0; i <= parts; ++i) {
        const double x = (20.0 + h * (static_cast<double>(k) + static_cast<double>(i) / parts)) / T;
        const double weight = i == 0 || i == parts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        sum -= weight * x * std::exp(-x);
      }
      return sum / (3.0 * parts);
    });
    expect_equal(evidence.rise_by_log_time(T), wanted, 1e-6);
  }
}

TEST(DriftEvidence, HasTheLineInSharesOfTheDuration) {
  for (const double start_s : {0.0, 20.0}) {
    const VectorXd wanted = transform_of(
        [&](std::size_t k) { return (start_s + (static_cast<double>(k) + 0.5) * h) / (n * h); });
    expect_equal(made(test::normals(n, 1), start_s).line(), wanted, 1e-10);
  }
}

TEST(DriftEvidence, HasAStepAtTheBeginningOfAnyBlock) {
  const DriftEvidence evidence = made(test::normals(n, 1));
  for (std::size_t block = 0; block < n; ++block)
    expect_equal(evidence.step(block),
                 transform_of([&](std::size_t k) { return k >= block ? 1.0 : 0.0; }), 1e-10);
}

TEST(DriftEvidence, HasAnImpulseForEachMissingBlock) {
  Series means = test::normals(n, 1);
  const std::vector<std::size_t> gone{0, 17, 18, n - 1};
  for (const std::size_t k : gone) means[k] = missing;
  const DriftEvidence evidence = made(means, 20.0);
  EXPECT_EQ(evidence.missing(), gone);
  ASSERT_EQ(evidence.dummies().cols(), 4);
  for (std::size_t j = 0; j < gone.size(); ++j)
    expect_equal(evidence.dummies().col(static_cast<Eigen::Index>(j)),
                 transform_of([&](std::size_t k) { return k == gone[j] ? 1.0 : 0.0; }), 1e-10);
}

TEST(DriftEvidence, FillsAGapByTheLineAcross) {
  Series means = test::ramp(0.5, 1.0, n), wanted = means;
  for (const std::size_t k : {0UL, 1UL, 30UL, 31UL, 32UL, n - 1}) means[k] = missing;
  wanted[0] = wanted[1] = wanted[2];
  wanted[n - 1] = wanted[n - 2];
  expect_equal(made(means).ordinates(), transform_of([&](std::size_t k) { return wanted[k]; }),
               1e-12);
}

TEST(DriftEvidence, GivesTheSeriesBack) {
  const Series means = test::normals(n, 2);
  const DriftEvidence evidence = made(means);
  const Series back = evidence.series(evidence.ordinates());
  ASSERT_EQ(back.size(), n);
  for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(back[k], means[k], 1e-12);
}

TEST(DriftEvidence, HasTheValueAtABlocksMiddle) {
  const Series means = test::normals(n, 3);
  const DriftEvidence evidence = made(means, 20.0);
  for (std::size_t k = 0; k < n; ++k) {
    const double middle_s = 20.0 + (static_cast<double>(k) + 0.5) * h;
    EXPECT_NEAR(evidence.at(middle_s).dot(evidence.ordinates()), means[k], 1e-12);
  }
}

TEST(DriftEvidence, HasTheRightTimes) {
  const DriftEvidence evidence = made(test::normals(n, 3), 20.0);
  EXPECT_EQ(evidence.blocks(), 96);
  EXPECT_DOUBLE_EQ(evidence.block_s(), 1.5);
  EXPECT_DOUBLE_EQ(evidence.duration_s(), 144.0);
  EXPECT_DOUBLE_EQ(evidence.end_s(), 164.0);
  EXPECT_DOUBLE_EQ(evidence.frequency_hz(96), 1.0 / 3.0);
}

TEST(DriftEvidence, KeepsTheSumOfSquaresAsADensity) {
  const Series means = test::white(0.7, 1.0 / h, n, 4);
  const DriftEvidence evidence = made(means);
  double squares = 0.0;
  for (const double mean : means) squares += h * mean * mean;
  EXPECT_NEAR(evidence.ordinates().squaredNorm(), squares, 1e-10);
}

TEST(DriftEvidence, NeedsTwelveBlocksAndHalfOfThem) {
  Series means = test::normals(11, 1);
  EXPECT_EQ(DriftEvidence::make(means, blocks_of_three, 0.0).error().code, Errc::too_few_samples);
  means.push_back(0.0);
  EXPECT_TRUE(DriftEvidence::make(means, blocks_of_three, 0.0));
  for (std::size_t k = 0; k < 6; ++k) means[k] = missing;
  EXPECT_TRUE(DriftEvidence::make(means, blocks_of_three, 0.0));
  means[6] = missing;
  const Error error = DriftEvidence::make(means, blocks_of_three, 0.0).error();
  EXPECT_EQ(error.code, Errc::too_few_samples);
  EXPECT_NE(error.message.find("7 are missing"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::characterise::drift_evidence_test
