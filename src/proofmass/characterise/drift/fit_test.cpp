#include "proofmass/characterise/drift/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/characterise/drift/drift_test_support.hpp"

namespace proofmass::characterise::drift_fit_test {
namespace {

using test::Series;

constexpr std::size_t n = 256;
constexpr Sampling sampling{0.25, 1};
constexpr double h = 4.0, record_s = 1024.0;

/// Block means of 4 s with white noise of density 1.
Series with_white(const Series& curve, unsigned seed, double white = 1.0) {
  return test::sum_of({curve, test::white(white, 0.25, curve.size(), seed)});
}

/// Properties of every fit, whatever the verdict.
void expect_sound(const DriftFit& fit) {
  EXPECT_EQ(fit.identified, fit.why == DriftReason::identified);
  EXPECT_EQ(fit.identified, fit.reason.empty());
  EXPECT_EQ(fit.identified, fit.a1.has_value() && fit.time_constant_s.has_value());
  for (const char* no_figure : {"nan", "inf"})
    EXPECT_EQ(fit.reason.find(no_figure), std::string::npos) << fit.reason;
  EXPECT_TRUE(std::ranges::is_sorted(fit.candidates, {}, &DriftCandidate::information_criterion));
  EXPECT_TRUE(std::ranges::all_of(fit.profile, [](const ProfilePoint& point) {
    return point.deviance >= 0.0 && std::isfinite(point.deviance);
  }));
  EXPECT_TRUE(std::ranges::is_sorted(fit.profile, {}, &ProfilePoint::time_constant_s));
  EXPECT_TRUE(fit.end.covariance.allFinite());
  EXPECT_GE(fit.a2.std, 0.0);
  EXPECT_GT(fit.undetected_below, 0.0);
}

DriftFit fitted(const Series& means, double start_s = 0.0) {
  DriftFit fit = fit_drift(test::evidence_of(means, sampling, start_s)).fit;
  expect_sound(fit);
  return fit;
}

bool holds(const Interval95& interval, double truth) {
  return interval.lower_95 && interval.upper_95 && *interval.lower_95 <= truth &&
         truth <= *interval.upper_95;
}

void expect_not_identified(const DriftFit& fit, DriftReason why) {
  EXPECT_FALSE(fit.identified);
  EXPECT_EQ(fit.why, why) << fit.reason;
}

/// A warm-up of T = 100 s in a record of 1024 s.
Series clear_warm_up(unsigned seed) {
  return with_white(test::warm_up(5.0, 100.0, 0.25, n), seed);
}

Series two_steps(unsigned seed) {
  return with_white(test::sum_of({test::step_at(100, 3.0, n), test::step_at(180, -4.0, n)}), seed);
}

// M. A. Lele's thesis (Dalhousie, 2010): a1 = 0.25, T = 70 s, a2 = −0.21 over two hours.
TEST(DriftFit, IdentifiesTheWarmUpOfTheThesis) {
  constexpr std::size_t samples = 7200;
  const Series curve =
      test::sum_of({test::warm_up(0.25, 70.0, 1.0, samples), test::level(-0.21, samples)});
  int held_a1 = 0, held_time = 0, held_a2 = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    SCOPED_TRACE(seed);
    const DriftFit fit =
        fit_drift(test::evidence_of(test::sum_of({curve, test::white(0.05, 1.0, samples, seed)}),
                                    {1.0, 6}))
            .fit;
    expect_sound(fit);
    ASSERT_TRUE(fit.identified);
    EXPECT_EQ(fit.curve.shape, DriftShape::exponential);
    held_a1 += holds(*fit.a1, 0.25) ? 1 : 0;
    held_time += holds(*fit.time_constant_s, 70.0) ? 1 : 0;
    held_a2 += holds(fit.a2, -0.21) ? 1 : 0;
    EXPECT_LT(fit.constant_p, 1e-6);
    EXPECT_NEAR(fit.noise.white, 0.05, 0.005);
  }
  // One in twenty intervals fails.
  EXPECT_GE(held_a1, 3);
  EXPECT_GE(held_time, 3);
  EXPECT_GE(held_a2, 3);
}

TEST(DriftFit, SeesNoWarmUpInWhiteNoise) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const DriftFit fit = fitted(with_white(test::level(0.0, n), seed));
    expect_not_identified(fit, DriftReason::no_warm_up);
    EXPECT_EQ(fit.curve.shape, DriftShape::constant);
    EXPECT_GT(fit.constant_p, 0.01);
  }
}

// An exponential absorbs most of a weak random walk, whose most likely strength is then zero:
// all eight forecasts were outside of their intervals, by up to nine standard deviations.
TEST(DriftFit, AForecastAllowsForARandomWalkThatTheCurveHides) {
  constexpr double walk = 0.02;
  int hidden = 0, held = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Series slow = test::sum_of({test::warm_up(20.0, 150.0, 0.25, n + n / 4),
                                      test::random_walk(walk, 0.25, n + n / 4, 1000 + seed)});
    const DriftFit fit = fitted(with_white({slow.begin(), slow.begin() + n}, seed));
    if (!fit.identified || fit.noise.random_walk > 0.0) continue;
    ASSERT_TRUE(fit.hidden_walk);
    EXPECT_GT(fit.hidden_walk->noise.random_walk, 0.0);
    ++hidden;
    const double later_s = static_cast<double>(slow.size() - 1) * 4.0;
    const Interval95 bias = forecast(fit, later_s).value().bias;
    held += holds(bias, slow.back()) ? 1 : 0;
    EXPECT_NEAR(bias.value, slow.back(), 5.0 * bias.std);
  }
  EXPECT_GE(hidden, 5);
  EXPECT_GE(held, hidden - 2);
}

TEST(DriftFit, TakesAStraightLineForALine) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const DriftFit fit = fitted(with_white(test::ramp(0.01, 0.25, n), seed));
    expect_not_identified(fit, DriftReason::line);
    EXPECT_EQ(fit.curve.shape, DriftShape::line);
    ASSERT_TRUE(fit.slope_per_s);
    EXPECT_TRUE(holds(*fit.slope_per_s, 0.01));
    ASSERT_TRUE(fit.time_constant_above_s);
    EXPECT_GT(*fit.time_constant_above_s, record_s);
  }
}

TEST(DriftFit, FindsStepsWhereTheyAre) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    // Ten times the noise between blocks.
    const DriftFit fit =
        fitted(with_white(test::sum_of({test::step_at(100, 5.0, n), test::step_at(180, -4.0, n)}),
                          seed, 0.6),
               60.0);
    expect_not_identified(fit, DriftReason::steps);
    ASSERT_EQ(fit.curve.steps.size(), 2U);
    EXPECT_DOUBLE_EQ(fit.curve.steps[0].t_s, 60.0 + 100.0 * h);
    EXPECT_DOUBLE_EQ(fit.curve.steps[1].t_s, 60.0 + 180.0 * h);
    EXPECT_NEAR(fit.curve.steps[0].size.value, 5.0, 4.0 * fit.curve.steps[0].size.std);
    EXPECT_NEAR(fit.curve.steps[1].size.value, -4.0, 4.0 * fit.curve.steps[1].size.std);
    EXPECT_NE(fit.reason.find("steps instead of an exponential: 2"), std::string::npos);
  }
}

TEST(DriftFit, TakesNoRandomWalkForAWarmUp) {
  int hidden = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const DriftFit fit = fitted(with_white(test::random_walk(0.1, 0.25, n, seed + 100), seed));
    EXPECT_FALSE(fit.identified);
    EXPECT_TRUE(fit.why == DriftReason::hidden_by_noise || fit.why == DriftReason::no_warm_up)
        << fit.reason;
    hidden += fit.why == DriftReason::hidden_by_noise ? 1 : 0;
    EXPECT_NEAR(fit.noise.random_walk, 0.1, 0.05);
  }
  // An ordinary fit would have been confident.
  EXPECT_GE(hidden, 1);
}

TEST(DriftFit, DoesNotIdentifyATimeConstantOfTwiceTheRecord) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Series curve = test::warm_up(10.0, 2.0 * record_s, 0.25, n);
    // With large noise it is taken as a straight line, with small noise as curved; in either case
    // beyond the record.
    expect_not_identified(fitted(with_white(curve, seed)), DriftReason::line);
    expect_not_identified(fitted(with_white(curve, seed, 0.01)), DriftReason::longer_than_record);
  }
}

TEST(DriftFit, DoesNotIdentifyATimeConstantOfAFewBlocks) {
  for (const unsigned seed : {1U, 2U, 3U})
    expect_not_identified(fitted(with_white(test::warm_up(20.0, 3.0 * h, 0.25, n), seed)),
                          DriftReason::shorter_than_resolved);
}

TEST(DriftFit, FindsTwoExponentialsTheLargerFirst) {
  int held = 0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const DriftFit fit = fitted(with_white(test::sum_of({test::warm_up(-3.0, 60.0, 0.25, 2 * n),
                                                         test::warm_up(6.0, 600.0, 0.25, 2 * n)}),
                                           seed, 0.1));
    ASSERT_TRUE(fit.identified) << fit.reason;
    ASSERT_EQ(fit.curve.shape, DriftShape::two_exponentials);
    ASSERT_TRUE(fit.second_a1 && fit.second_time_constant_s);
    held += holds(*fit.a1, 6.0) ? 1 : 0;
    held += holds(*fit.time_constant_s, 600.0) ? 1 : 0;
    held += holds(*fit.second_a1, -3.0) ? 1 : 0;
    held += holds(*fit.second_time_constant_s, 60.0) ? 1 : 0;
  }
  // of twelve
  EXPECT_GE(held, 9);
}

TEST(DriftFit, FindsAnExponentialAndALine) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const DriftFit fit = fitted(with_white(
        test::sum_of({test::warm_up(5.0, 100.0, 0.25, n), test::ramp(0.005, 0.25, n)}), seed, 0.3));
    ASSERT_TRUE(fit.identified) << fit.reason;
    ASSERT_EQ(fit.curve.shape, DriftShape::exponential_and_line);
    ASSERT_TRUE(fit.slope_per_s);
    EXPECT_TRUE(holds(*fit.a1, 5.0));
    EXPECT_TRUE(holds(*fit.time_constant_s, 100.0));
    EXPECT_TRUE(holds(*fit.slope_per_s, 0.005));
  }
}

void expect_scaled(const Interval95& found, const Interval95& wanted, double factor) {
  const double reach = 0.01 * wanted.std * factor;
  EXPECT_NEAR(found.value, factor * wanted.value, reach);
  EXPECT_NEAR(found.std, factor * wanted.std, reach);
  EXPECT_NEAR(*found.lower_95, factor * *wanted.lower_95, 5.0 * reach);
  EXPECT_NEAR(*found.upper_95, factor * *wanted.upper_95, 5.0 * reach);
}

TEST(DriftFit, ScalesWithTheUnit) {
  const DriftFit fit = fitted(clear_warm_up(1));
  const DriftFit of_steps = fitted(two_steps(1));
  ASSERT_TRUE(fit.identified);
  for (const double factor : {1e-6, 1e6, -1.0}) {
    SCOPED_TRACE(factor);
    const DriftFit other = fitted(test::scaled(clear_warm_up(1), factor));
    ASSERT_TRUE(other.identified);
    EXPECT_NEAR(other.a1->value, factor * fit.a1->value, 0.01 * std::abs(factor) * fit.a1->std);
    EXPECT_NEAR(other.a1->std, std::abs(factor) * fit.a1->std,
                0.01 * std::abs(factor) * fit.a1->std);
    expect_scaled(*other.time_constant_s, *fit.time_constant_s, 1.0);
    if (factor > 0.0) expect_scaled(other.a2, fit.a2, factor);
    const DriftFit other_steps = fitted(test::scaled(two_steps(1), factor));
    EXPECT_EQ(other_steps.why, of_steps.why);
    EXPECT_EQ(other_steps.curve.steps.size(), of_steps.curve.steps.size());
  }
}

TEST(DriftFit, DoesNotMindGravity) {
  const DriftFit fit = fitted(clear_warm_up(2));
  const DriftFit heavy = fitted(test::sum_of({clear_warm_up(2), test::level(9.8, n)}));
  ASSERT_TRUE(fit.identified && heavy.identified);
  expect_scaled(*heavy.a1, *fit.a1, 1.0);
  expect_scaled(*heavy.time_constant_s, *fit.time_constant_s, 1.0);
  EXPECT_NEAR(heavy.a2.value - fit.a2.value, 9.8, 0.01 * fit.a2.std);
}

TEST(DriftFit, CountsTimeFromSwitchingOn) {
  // The same warm-up, observed from 200 s on.
  const Series late = test::warm_up(40.0, 100.0, 0.25, n + 50);
  const DriftFit fit = fitted(with_white(Series(late.begin() + 50, late.end()), 3, 0.2), 200.0);
  ASSERT_TRUE(fit.identified) << fit.reason;
  EXPECT_TRUE(holds(*fit.a1, 40.0));
  EXPECT_TRUE(holds(*fit.time_constant_s, 100.0));
  EXPECT_TRUE(holds(fit.a2, 0.0));
  EXPECT_DOUBLE_EQ(fit.end.t_s, 200.0 + record_s);
}

TEST(DriftFit, GoesAcrossMissingBlocks) {
  Series means = clear_warm_up(4);
  for (std::size_t k = 50; k < 70; ++k) means[k] = std::numeric_limits<double>::quiet_NaN();
  const FittedDrift found = fit_drift(test::evidence_of(means, sampling));
  expect_sound(found.fit);
  ASSERT_TRUE(found.fit.identified);
  EXPECT_TRUE(holds(*found.fit.a1, 5.0));
  EXPECT_TRUE(holds(*found.fit.time_constant_s, 100.0));
  for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(std::isnan(found.whitened[k]), k >= 50 && k < 70);
}

// --- other shapes --------------------------------------------------------------------------------

/// Values of a curve at the centre of each block.
Series sampled(double (*curve)(double t_s)) {
  Series y(n);
  for (std::size_t k = 0; k < n; ++k) y[k] = curve(h * (static_cast<double>(k) + 0.5));
  return y;
}

bool allows(const DriftFit& fit, DriftShape shape) {
  return std::ranges::any_of(fit.possibilities,
                             [&](const DriftPossibility& one) { return one.curve.shape == shape; });
}

struct OtherShape {
  DriftShape shape;
  double (*curve)(double t_s);
};

// Each rises by some 5 over the record, in white noise of 0.15 per block.
constexpr std::array<OtherShape, 4> other_shapes{
    {{DriftShape::square_root, [](double t) { return 0.16 * std::sqrt(t); }},
     {DriftShape::logarithm, [](double t) { return 1.6 * std::log(1.0 + t / 45.0); }},
     {DriftShape::hyperbola, [](double t) { return 6.0 - 6.0 / (1.0 + t / 120.0); }},
     {DriftShape::stretched_exponential,
      [](double t) { return 6.0 * (1.0 - std::exp(-std::sqrt(t / 120.0))); }}}};

TEST(DriftFit, DoesNotCallAnExponentialWhatIsAnotherShape) {
  for (const OtherShape& other : other_shapes) {
    SCOPED_TRACE(name_of(other.shape));
    int allowed = 0;
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
      const DriftFit fit = fitted(with_white(sampled(other.curve), seed, 0.3));
      expect_not_identified(fit, DriftReason::shape_undetermined);
      EXPECT_NE(fit.reason.find("its shape cannot be determined"), std::string::npos);
      allowed += allows(fit, other.shape) ? 1 : 0;
      const DriftForecast later = forecast(fit, 1.2 * record_s).value();
      EXPECT_TRUE(holds(later.bias, other.curve(1.2 * record_s))) << seed;
    }
    EXPECT_GE(allowed, 3);
  }
}

TEST(DriftFit, DoesNotCallAnOscillationOfTheTemperatureAWarmUp) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const DriftFit whole = fitted(with_white(
        sampled([](double t) { return 3.0 * std::sin(6.2831853 * t / record_s); }), seed, 1.0));
    EXPECT_FALSE(whole.identified) << whole.reason;
    const DriftFit half = fitted(with_white(
        sampled([](double t) { return 5.0 * std::sin(3.1415927 * t / record_s); }), seed, 1.0));
    EXPECT_FALSE(half.identified) << half.reason;
    const DriftFit quarter = fitted(with_white(
        sampled([](double t) { return 5.0 * std::sin(1.5707963 * t / record_s); }), seed, 1.0));
    EXPECT_FALSE(quarter.identified) << quarter.reason;
  }
}

// A curve by its definition, with block means by a fine sum: an independent computation of the
// fit's columns.
TEST(DriftFit, FindsTheScaleOfALogarithmWithinItsStd) {
  Series y(n, 0.0);
  constexpr int parts = 200;
  for (std::size_t k = 0; k < n; ++k)
    for (int j = 0; j < parts; ++j)
      y[k] += 2.0 * std::log(1.0 + h * (static_cast<double>(k) + (j + 0.5) / parts) / 30.0) / parts;
  const DriftFit fit = fitted(with_white(y, 1, 0.02));
  ASSERT_EQ(fit.why, DriftReason::shape_undetermined) << fit.reason;
  ASSERT_EQ(fit.curve.shape, DriftShape::logarithm);
  const double std_of_log = std::sqrt(fit.curve.covariance(2, 2));
  EXPECT_NEAR(std::log(fit.curve.time_constant_s / 30.0), 0.0, 3.0 * std_of_log);
  EXPECT_NEAR(fit.curve.a1, 2.0, 3.0 * std::sqrt(fit.curve.covariance(1, 1)));
  EXPECT_LT(std_of_log, 0.05);
}

// The whitened residuals of a model that fits have variance 1, since density times block length is
// 1.
TEST(DriftFit, WhitensByTheNoiseItFitted) {
  const FittedDrift found = fit_drift(test::evidence_of(
      test::sum_of({clear_warm_up(5), test::random_walk(0.2, 0.25, n, 6)}), sampling));
  double squares = 0.0, products = 0.0;
  for (std::size_t k = 0; k < n; ++k) squares += h * found.whitened[k] * found.whitened[k];
  for (std::size_t k = 1; k < n; ++k) products += h * found.whitened[k] * found.whitened[k - 1];
  EXPECT_NEAR(squares / n, 1.0, 0.1);
  // Three standard deviations of a first autocorrelation.
  EXPECT_NEAR(products / squares, 0.0, 3.0 / std::sqrt(static_cast<double>(n)));
}

// Under white noise the random walk is dropped, and the bound is that of least squares over blocks.
TEST(DriftFit, StatesTheSmallestDetectableWarmUp) {
  const Series means = with_white(test::level(0.0, n), 7);
  const DriftFit fit = fitted(means);
  ASSERT_EQ(fit.noise.random_walk, 0.0);
  const DriftEvidence evidence = test::evidence_of(means, sampling);
  Eigen::MatrixXd X(n, 2);
  const Series rise = evidence.series(evidence.rise(0.2 * record_s));
  for (std::size_t k = 0; k < n; ++k) X.row(static_cast<Eigen::Index>(k)) << 1.0, rise[k];
  const double white = fit.noise.white;
  const test::DenseFit dense = test::fit_dense(
      test::vector_of(means), {white * white / h * Eigen::MatrixXd::Identity(n, n), X});
  EXPECT_NEAR(fit.undetected_below,
              std::abs(dense.coefficients(1)) + 1.959964 * std::sqrt(dense.covariance(1, 1)), 1e-6);
}

// The loss at the ends of an interval defines it: 3.84, and slightly more if the noise has few
// degrees of freedom.
TEST(DriftFit, HasAProfileThatCrossesItsBoundAtTheEndsOfTheInterval) {
  const DriftFit fit = fitted(clear_warm_up(8));
  ASSERT_TRUE(fit.identified);
  const auto deviance_at = [&](double time_s) {
    const auto above =
        std::ranges::lower_bound(fit.profile, time_s, {}, &ProfilePoint::time_constant_s);
    const auto below = above - 1;
    const double share =
        (time_s - below->time_constant_s) / (above->time_constant_s - below->time_constant_s);
    return below->deviance + share * (above->deviance - below->deviance);
  };
  EXPECT_LT(deviance_at(fit.time_constant_s->value), 0.02);
  for (const double end : {*fit.time_constant_s->lower_95, *fit.time_constant_s->upper_95}) {
    EXPECT_GT(deviance_at(end), 3.8);
    EXPECT_LT(deviance_at(end), 4.2);
  }
}

}  // namespace
}  // namespace proofmass::characterise::drift_fit_test
