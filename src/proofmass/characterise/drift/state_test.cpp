#include "proofmass/characterise/drift/state.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "proofmass/characterise/drift/drift_test_support.hpp"

namespace proofmass::characterise::drift_state_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Series;

constexpr std::size_t n = 128;
constexpr double rate_hz = 0.5, h = 2.0, N = 1.0, K = 0.03, T = 40.0;

/// A shape fitted with given noise and fixed time constants, as by try_shape.
DriftFitAtShape trial_of(const DriftEvidence& evidence, const ShapeAt& at) {
  DriftFitAtShape trial;
  trial.at = at;
  trial.noise = NoiseChoice(evidence).base();
  trial.fit = evaluate_ordinates(evidence.ordinates().tail(evidence.blocks() - 1), trial.noise.P,
                                 restricted(evidence, at), Eigen::Vector2d(N * N, K * K));
  return trial;
}

Series record(unsigned seed) {
  return test::sum_of({test::warm_up(4.0, T, rate_hz, n), test::level(9.8, n),
                       test::white(N, rate_hz, n, seed),
                       test::random_walk(K, rate_hz, n, seed + 1)});
}

/// Result of the dense model with W(0) = 0 for [parameters of the curve; W at the end].
struct Wanted {
  VectorXd value;
  MatrixXd covariance;
};

Wanted dense(const DriftEvidence& evidence, const Series& samples, const ShapeAt& at, double a1) {
  std::vector<Index> present;
  for (std::size_t k = 0; k < n; ++k)
    if (!std::isnan(samples[k])) present.push_back(static_cast<Index>(k));
  const auto rows = static_cast<Index>(present.size());
  const double start_s = evidence.start_s();
  const MatrixXd all =
      test::white_and_walk(N, K, h, static_cast<Index>(n)).array() + K * K * start_s;
  const Index columns = at.shape == DriftShape::exponential ? 2 : 3;
  MatrixXd X(rows, columns), tangent(rows, columns + 1);
  VectorXd y(rows), of_end(rows);
  const Series rise = evidence.series(evidence.rise(T));
  const Series by_log_time = evidence.series(evidence.rise_by_log_time(T));
  for (Index i = 0; i < rows; ++i) {
    const auto k = static_cast<std::size_t>(present[static_cast<std::size_t>(i)]);
    const double t_s = start_s + (static_cast<double>(k) + 0.5) * h;
    y(i) = samples[k];
    of_end(i) = K * K * t_s;
    X.row(i).head(2) << 1.0, rise[k];
    if (columns == 3) X(i, 2) = t_s;
    tangent.row(i).head(3) << 1.0, rise[k], a1 * by_log_time[k];
    if (columns == 3) tangent(i, 3) = t_s;
  }
  const MatrixXd V = all(present, present);
  const test::DenseFit held = test::fit_dense(y, {V, X}), free = test::fit_dense(y, {V, tangent});
  Wanted wanted;
  wanted.value.resize(columns + 1);
  wanted.value << held.coefficients, of_end.dot(held.inverse * held.residual);
  const VectorXd sensitivity = -tangent.transpose() * (free.inverse * of_end);
  const Index last = columns + 1;
  wanted.covariance.resize(last + 1, last + 1);
  wanted.covariance.topLeftCorner(last, last) = free.covariance;
  wanted.covariance.col(last).head(last) = free.covariance * sensitivity;
  wanted.covariance.row(last) = wanted.covariance.col(last).transpose();
  wanted.covariance(last, last) = K * K * evidence.end_s() - of_end.dot(free.inverse * of_end) +
                                  sensitivity.dot(free.covariance * sensitivity);
  return wanted;
}

// The fit treats the blocks as means over continuous time, for which the walk before the first and
// after the last block has variance K² h/3; for samples at the centres of their blocks it is K²
// h/2, and the walk at an edge is interpolated. The tolerance for the level and the walk at the end
// is therefore K² h in variance, 1.4 % of theirs here, and a tenth of √(K² h) in value; all else is
// exact.
struct Held {
  Wanted wanted;
  VectorXd value;
  MatrixXd covariance;

  void expect_curve() const {
    const Index own = wanted.covariance.rows() - 2;
    EXPECT_TRUE(value.segment(1, wanted.value.size() - 2)
                    .isApprox(wanted.value.segment(1, wanted.value.size() - 2), 1e-8));
    EXPECT_TRUE(
        covariance.block(1, 1, own, own).isApprox(wanted.covariance.block(1, 1, own, own), 1e-7));
  }
  void expect_level_and_walk() const {
    const Index last = wanted.covariance.rows() - 1;
    const double of_step = K * K * h, reach = 0.1 * std::sqrt(of_step);
    EXPECT_NEAR(value(0), wanted.value(0), reach);
    EXPECT_NEAR(value(value.size() - 1), wanted.value(value.size() - 1), reach);
    for (const Index i : {Index{0}, last}) {
      for (const Index j : {Index{0}, last})
        EXPECT_NEAR(covariance(i, j), wanted.covariance(i, j), of_step) << i << ", " << j;
      for (Index j = 1; j < last; ++j)
        EXPECT_NEAR(covariance(i, j), wanted.covariance(i, j),
                    reach * std::sqrt(wanted.covariance(j, j)))
            << i << ", " << j;
    }
  }
};

Held held(const Series& samples, const ShapeAt& at, double start_s) {
  const DriftEvidence evidence = test::evidence_of(samples, {rate_hz, 1}, start_s);
  const PlacedCurve placed = place(evidence, trial_of(evidence, at));
  Held found;
  found.wanted = dense(evidence, samples, at, placed.curve.a1);
  found.value.resize(found.wanted.value.size());
  found.value.head(2) << placed.curve.a2, placed.curve.a1;
  if (at.shape == DriftShape::exponential_and_line) found.value(2) = placed.curve.slope_per_s;
  found.value.tail(1) << placed.end.slow_noise(0);
  const Index entries = found.wanted.covariance.rows();
  found.covariance = placed.end.covariance.topLeftCorner(entries, entries);
  // The noise has neither flicker nor a Markov term.
  EXPECT_EQ(placed.end.covariance.rows(), entries + 2);
  EXPECT_EQ(placed.end.covariance.rightCols(2).norm(), 0.0);
  EXPECT_EQ(placed.end.slow_noise.tail(2).norm(), 0.0);
  EXPECT_TRUE(
      placed.curve.covariance.isApprox(found.covariance.topLeftCorner(entries - 1, entries - 1)));
  return found;
}

Series with_gap(Series samples) {
  for (const std::size_t k : {7UL, 8UL, 60UL, n - 1})
    samples[k] = std::numeric_limits<double>::quiet_NaN();
  return samples;
}

void expect_dense(const Series& samples, const ShapeAt& at) {
  for (const double start_s : {0.0, 50.0}) {
    SCOPED_TRACE(start_s);
    const Held found = held(samples, at, start_s);
    found.expect_curve();
    found.expect_level_and_walk();
  }
}

const ShapeAt exponential{DriftShape::exponential, {std::log(T)}, {}};
const ShapeAt exponential_and_line{DriftShape::exponential_and_line, {std::log(T)}, {}};

TEST(DriftState, OfAnExponentialIsTheDenseModelWhoseWalkStartsAtSwitchingOn) {
  for (const unsigned seed : {1U, 3U, 5U}) expect_dense(record(seed), exponential);
}

TEST(DriftState, OfAnExponentialAndALineIsTheDenseModel) {
  for (const unsigned seed : {1U, 3U, 5U}) expect_dense(record(seed), exponential_and_line);
}

TEST(DriftState, GoesAcrossMissingBlocksAsTheDenseModelDoes) {
  for (const unsigned seed : {1U, 3U}) {
    expect_dense(with_gap(record(seed)), exponential);
    expect_dense(with_gap(record(seed)), exponential_and_line);
  }
}

// Only the level: its variance is N²/duration.
TEST(DriftState, OfAConstantInWhiteNoiseIsTheMean) {
  const Series samples = test::white(N, rate_hz, n, 7);
  const DriftEvidence evidence = test::evidence_of(samples, {rate_hz, 1});
  DriftFitAtShape trial = trial_of(evidence, {DriftShape::constant, {}, {}});
  trial.noise = NoiseChoice(evidence).white();
  trial.fit = fit_ordinates(evidence.ordinates().tail(evidence.blocks() - 1), trial.noise.P, {});
  const PlacedCurve placed = place(evidence, trial);
  const double white = noise_of(trial).white;
  double mean = 0.0, squares = 0.0;
  for (const double y : samples) mean += y / static_cast<double>(n);
  for (const double y : samples) squares += (y - mean) * (y - mean);
  EXPECT_NEAR(placed.curve.a2, mean, 1e-12);
  EXPECT_NEAR(white * white, h * squares / (static_cast<double>(n) - 1.0), 1e-5);
  EXPECT_NEAR(placed.curve.covariance(0, 0), white * white / evidence.duration_s(), 1e-12);
}

TEST(DriftState, OfStepsHasTheirTimesSizesAndErrors) {
  const Series samples =
      test::sum_of({record(9), test::step_at(50, 6.0, n), test::step_at(90, -4.0, n)});
  const DriftEvidence evidence = test::evidence_of(samples, {rate_hz, 1}, 50.0);
  const DriftFitAtShape trial = trial_of(evidence, {DriftShape::steps, {}, {50, 90}});
  const PlacedCurve placed = place(evidence, trial);
  ASSERT_EQ(placed.curve.steps.size(), 2U);
  EXPECT_DOUBLE_EQ(placed.curve.steps[0].t_s, 50.0 + 50.0 * h);
  EXPECT_DOUBLE_EQ(placed.curve.steps[1].t_s, 50.0 + 90.0 * h);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto entry = static_cast<Index>(k);
    EXPECT_DOUBLE_EQ(placed.curve.steps[k].size.value, trial.fit.coefficients(entry));
    EXPECT_NEAR(placed.curve.steps[k].size.std, std::sqrt(trial.fit.covariance(entry, entry)),
                1e-10);
  }
}

/// The exponential with white noise and a Markov term of given strength.
DriftFitAtShape markov_trial(const DriftEvidence& evidence, double q, double relaxation_s) {
  DriftFitAtShape trial;
  trial.at = exponential;
  trial.noise = NoiseChoice(evidence).white();
  const Index rows = evidence.blocks() - 1;
  trial.noise.P.conservativeResize(rows, 2);
  for (Index k = 0; k < rows; ++k)
    trial.noise.P(k, 1) =
        relaxation_s * relaxation_s *
        relaxation_density(relaxation_s, evidence.frequency_hz(k + 1), evidence.sampling());
  trial.noise.terms.push_back(Term::markov);
  trial.noise.markov_time_constant_s = relaxation_s;
  trial.fit = evaluate_ordinates(evidence.ordinates().tail(rows), trial.noise.P,
                                 restricted(evidence, exponential), Eigen::Vector2d(N * N, q * q));
  return trial;
}

/// [a2; a1; ln T; Markov noise at the end] with a stationary Markov process, dense.
Wanted dense_markov(const DriftEvidence& evidence, const Series& samples, double q, double a1) {
  const double relaxation_s = evidence.duration_s() / 25.6, phi = std::exp(-h / relaxation_s);
  const double scale = q * relaxation_s * (1.0 - phi);
  const double variance = scale * scale / (h * (1.0 - phi * phi));
  const auto rows = static_cast<Index>(n);
  MatrixXd V(rows, rows), X(rows, 3);
  VectorXd of_end(rows);
  const Series rise = evidence.series(evidence.rise(T));
  const Series by_log_time = evidence.series(evidence.rise_by_log_time(T));
  for (Index i = 0; i < rows; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (Index j = 0; j < rows; ++j)
      V(i, j) = variance * std::pow(phi, static_cast<double>(std::abs(i - j))) +
                (i == j ? N * N / h : 0.0);
    of_end(i) = variance * std::pow(phi, static_cast<double>(rows - i) - 0.5);
    X.row(i) << 1.0, rise[k], a1 * by_log_time[k];
  }
  const VectorXd y = test::vector_of(samples);
  const test::DenseFit held = test::fit_dense(y, {V, X.leftCols(2)});
  const test::DenseFit free = test::fit_dense(y, {V, X});
  const VectorXd sensitivity = -X.transpose() * (free.inverse * of_end);
  Wanted wanted{VectorXd(3), MatrixXd::Zero(4, 4)};
  wanted.value << held.coefficients, of_end.dot(held.inverse * held.residual);
  wanted.covariance.topLeftCorner(3, 3) = free.covariance;
  wanted.covariance(3, 3) =
      variance - of_end.dot(free.inverse * of_end) + sensitivity.dot(free.covariance * sensitivity);
  return wanted;
}

// The cosine transform treats a stationary process as reflected at both ends of the record, which
// doubles its variance there. With a record of 26 relaxation times the variances of the curve are
// up to 1.4 times too large and that of the Markov noise at the end up to 2.1 times, never too
// small.
TEST(DriftState, OfMarkovNoiseErrsOnTheWideSideAndNotByMuch) {
  for (const double q : {0.05, 0.2}) {
    const double relaxation_s = static_cast<double>(n) * h / 25.6;
    const Series samples =
        test::sum_of({test::warm_up(4.0, T, rate_hz, n), test::white(N, rate_hz, n, 1),
                      test::markov(q, relaxation_s, rate_hz, n, 2)});
    const DriftEvidence evidence = test::evidence_of(samples, {rate_hz, 1});
    const PlacedCurve placed = place(evidence, markov_trial(evidence, q, relaxation_s));
    const Wanted wanted = dense_markov(evidence, samples, q, placed.curve.a1);
    const MatrixXd& C = placed.end.covariance;
    for (Index k = 0; k < 3; ++k) {
      EXPECT_GE(C(k, k), 0.99 * wanted.covariance(k, k)) << k;
      EXPECT_LE(C(k, k), 1.4 * wanted.covariance(k, k)) << k;
    }
    EXPECT_GE(C(5, 5), wanted.covariance(3, 3));
    EXPECT_LE(C(5, 5), 2.1 * wanted.covariance(3, 3));
    const auto near = [&](double value, Index value_at, Index entry) {
      EXPECT_NEAR(value, wanted.value(value_at), 0.3 * std::sqrt(wanted.covariance(entry, entry)));
    };
    near(placed.curve.a2, 0, 0);
    near(placed.curve.a1, 1, 1);
    near(placed.end.slow_noise(2), 2, 3);
  }
}

}  // namespace
}  // namespace proofmass::characterise::drift_state_test
